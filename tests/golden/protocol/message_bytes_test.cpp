#include <catch2/catch.hpp>

#include "protocol/codec/handshake.hpp"
#include "protocol/codec/messages.hpp"
#include "tests/support/hex.hpp"

// Messages as version 1 of the protocol wrote them. Reading them must never change: peers of that version are
// out there. How FlatBuffers arranges the fields may differ between its releases, so writing is not pinned.
namespace runstone::test {
namespace {

Message read(Sender sender, FrameClass frame_class, const char* hex, std::uint16_t chunk_edge = 16) {
  const auto decoded = decode_message(sender, frame_class, from_hex(hex), chunk_edge);
  if (!decoded) FAIL(decoded.error().what);
  return *decoded;
}

template <std::size_t N>
std::array<std::uint8_t, N> counting(std::uint8_t first) {
  std::array<std::uint8_t, N> out{};
  for (auto& byte : out) byte = first++;
  return out;
}

Hello a_hello() {
  Hello m;
  m.key = counting<32>(0);
  m.instance = 0x0123456789abcdefULL;
  m.nonce = counting<32>(0x80);
  m.name = "Ren\xc3\xa9";
  m.encodings = 3;
  return m;
}

KeyPair keys_of(std::uint8_t byte) {
  KeySeed seed;
  seed.fill(byte);
  return key_pair_of(seed);
}

Welcome a_welcome() {
  Welcome m;
  m.world_id = counting<16>(0x10);
  m.epoch = 3;
  m.durable = 480;
  m.head = 499;
  m.chunk_edge = 32;
  m.y_min = -64;
  m.y_max = 192;
  m.spawn = {0.5, 70, -0.25};
  REQUIRE(m.materials.add({"stone", {128, 128, 128, 255}, Visibility::opaque, std::nullopt}).has_value());
  m.server_key = keys_of(1).public_key;
  m.challenge = counting<32>(0x40);
  m.encoding = ChunkEncoding::packed;
  m.edit_volume_max = 1'000'000;
  m.view_radius_max = 16;
  return m;
}

constexpr const char* kServerSignature =
    "ad3dd6f04410814ac7b2478af7906f9ae3d212f3f04f5b1bef72a6f78ac4bb22"
    "2847ecc28deb6cf8c6d1ea1104a8aeebea09eb68ea3f23b5fb72853927ce0008";

}  // namespace

TEST_CASE("hello of protocol 1 is read", "[protocol][golden]") {
  const Message read_back = read(Sender::client, FrameClass::control,
                                 "1400000052554e310000000008000c0007000800080000000000000114000000"
                                 "1000240008000c00180010001400070010000000000000030100000048000000"
                                 "2000000010000000efcdab8967452301000000000500000052656ec3a9000000"
                                 "20000000808182838485868788898a8b8c8d8e8f909192939495969798999a9b"
                                 "9c9d9e9f20000000000102030405060708090a0b0c0d0e0f1011121314151617"
                                 "18191a1b1c1d1e1f");
  CHECK(read_back == Message(a_hello()));
}

TEST_CASE("welcome of protocol 1 is read, and its signature holds", "[protocol][golden]") {
  const Message read_back = read(Sender::server, FrameClass::control,
                                 "1400000052554e310000000008000c0007000800080000000000000228000000"
                                 "24005c0008000c00100044004c000600140018001c00340038003c0040000400"
                                 "54000500240000000210200001000000dc00000003000000c0ffffffc0000000"
                                 "000000000000e03f0000000000805140000000000000d0bfc80000008c000000"
                                 "640000001c000000e001000000000000f30100000000000040420f0000000000"
                                 "40000000ad3dd6f04410814ac7b2478af7906f9ae3d212f3f04f5b1bef72a6f7"
                                 "8ac4bb222847ecc28deb6cf8c6d1ea1104a8aeebea09eb68ea3f23b5fb728539"
                                 "27ce000820000000404142434445464748494a4b4c4d4e4f5051525354555657"
                                 "58595a5b5c5d5e5f200000008a88e3dd7409f195fd52db2d3cba5d72ca6709bf"
                                 "1d94121bf3748801b40f6f5c10000000101112131415161718191a1b1c1d1e1f"
                                 "02000000340000001000000000000a00100008000c0007000a00000000000001"
                                 "08000000808080ff0500000073746f6e65000600080004000600000004000000"
                                 "0300000061697200",
                                 0);
  Welcome expected = a_welcome();
  const Bytes signature = from_hex(kServerSignature);
  std::copy(signature.begin(), signature.end(), expected.signature.begin());
  CHECK(read_back == Message(expected));
  Hello hello = a_hello();
  hello.key = keys_of(2).public_key;
  const auto& welcome = std::get<Welcome>(read_back);
  CHECK(verify(welcome.server_key, server_transcript(hello, welcome), welcome.signature));
}

TEST_CASE("an edit request of protocol 1 is read", "[protocol][golden]") {
  const Message read_back = read(Sender::client, FrameClass::edits,
                                 "1000000052554e3108000e000700080008000000000000081000000000000a00"
                                 "1c000800100004000a000000180000000700000000000000a0f0190000000000"
                                 "000000000e0000000203ffff03000100c801001fff1f0000");
  const EditRequest expected{
      7, 1'700'000, {FillBox{{{-1, 0, 100}, {0, 32, 4196}}}, {MaskKind::only_material, 65535}, 0}};
  CHECK(read_back == Message(expected));
}

TEST_CASE("a commit of protocol 1 is read", "[protocol][golden]") {
  const Message read_back = read(Sender::server, FrameClass::edits,
                                 "1400000052554e310000000008000e0007000800080000000000000910000000"
                                 "00000a00140004000c0008000a000000030000000c000000f401000000000000"
                                 "020000005c000000180000001400180000000000000007000000100008000c00"
                                 "1400000000000001180000000c0000009af119000000000004000000f5038301"
                                 "0700000003020720101003001400340004001000180000002000280008000c00"
                                 "1400000002000000340000002800000088776655443322110900000000000000"
                                 "a0f01900000000009af119000000000000000000010000000100000007000000"
                                 "0100ac0202030600");
  Commit expected;
  expected.epoch = 3;
  expected.first = 500;
  expected.edits.push_back({{2, 0x1122334455667788ULL, 9},
                            Cause::player,
                            1'700'000,
                            1'700'250,
                            {SetVoxel{{1, -2, 3}}, {}, 300},
                            {499}});
  expected.edits.push_back({{0, 0, 0},
                            Cause::console,
                            0,
                            1'700'250,
                            {FillSphere{{16, 8, 8}, 3}, {MaskKind::only_solid, 0}, 7},
                            {0, 370}});
  CHECK(read_back == Message(expected));
}

TEST_CASE("handshake transcripts and signatures are pinned", "[protocol][golden]") {
  Hello hello = a_hello();
  hello.key = keys_of(2).public_key;
  const Welcome welcome = a_welcome();
  const Bytes transcript = server_transcript(hello, welcome);
  CHECK(to_hex(transcript) ==
        to_hex(from_hex(
            "12000000 72756e73746f6e6520736572766572207631"  // "runstone server v1"
            "04000000 01000000"                              // hello.protocol
            "20000000 8139770ea87d175f56a35466c34c7ecccb8d8a91b4ee37a25df60f5b8fc9b394"  // hello.key
            "08000000 efcdab8967452301"                                                  // hello.instance
            "20000000 808182838485868788898a8b8c8d8e8f909192939495969798999a9b9c9d9e9f"  // hello.nonce
            "05000000 52656ec3a9"                                                        // hello.name
            "01000000 03"                                                                // hello.encodings
            "04000000 01000000"                                                          // welcome.protocol
            "10000000 101112131415161718191a1b1c1d1e1f"                                  // world_id
            "04000000 03000000"                                                          // epoch
            "08000000 e001000000000000"                                                  // durable
            "08000000 f301000000000000"                                                  // head
            "02000000 2000"                                                              // chunk_edge
            "04000000 c0ffffff"                                                          // y_min
            "04000000 c0000000"                                                          // y_max
            "08000000 000000000000e03f 08000000 0000000000805140 08000000 000000000000d0bf"  // spawn
            "04000000 02000000"                                                              // rows
            "03000000 616972 04000000 00000000 01000000 00"                                  // air
            "05000000 73746f6e65 04000000 808080ff 01000000 01"                              // stone
            "20000000 8a88e3dd7409f195fd52db2d3cba5d72ca6709bf1d94121bf3748801b40f6f5c"      // server_key
            "20000000 404142434445464748494a4b4c4d4e4f505152535455565758595a5b5c5d5e5f"      // challenge
            "01000000 02"                                                                    // encoding
            "08000000 40420f0000000000"  // edit_volume_max
            "01000000 10")));            // view_radius_max
  CHECK(to_hex(sign(keys_of(1), transcript)) == kServerSignature);
  CHECK(to_hex(sign(keys_of(2), client_transcript(hello, welcome))) ==
        "530dcbf4ddc2934bda27a08799611c831f6f8a6393ec6b49b7e121327e450788"
        "6d579abf9b746e555b2087b46030011aa1cad26f81b9c727f6ea292ddc017b0e");
}

}  // namespace runstone::test
