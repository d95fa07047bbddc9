#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <string>

#include "protocol/codec/chunk_lists.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/messages.hpp"
#include "tests/support/hex.hpp"

// Messages as versions 1 and 2 of the protocol wrote them; they differ only in the version of Hello
// and Welcome. How they are decoded must never change. Releases of FlatBuffers may arrange fields
// differently, so the encoder's bytes are not pinned.
namespace runstone::test {
namespace {

Message read(Sender sender, FrameClass frame_class, const char* hex,
             std::uint16_t chunk_edge = 16) {
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
  m.features = 0x8000000000000005ULL;
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
  m.heights = {-64, 192};
  m.spawn = {0.5, 70, -0.25};
  REQUIRE(m.materials.add({"stone", {128, 128, 128, 255}, Visibility::opaque, std::nullopt})
              .has_value());
  m.server_key = keys_of(1).public_key;
  m.challenge = counting<32>(0x40);
  m.encoding = ChunkEncoding::packed;
  m.edit_volume_max = 1'000'000;
  m.view_radius_max = 16;
  m.features = 5;
  return m;
}

/// Returns the hexadecimal digits of the example in docs/protocol.md. A comment follows two blanks
/// or more.
std::string transcript_of_the_page() {
  std::ifstream file(RUNSTONE_SOURCE_DIR "/docs/protocol.md");
  std::string digits;
  bool is_inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line == "```transcript") {
      is_inside = true;
    } else if (is_inside && line == "```") {
      break;
    } else if (is_inside) {
      line.resize(std::min(line.find("  "), line.size()));
      std::erase(line, ' ');
      digits += line;
    }
  }
  return digits;
}

constexpr const char* kServerSignature =
    "69604b4a6c7cd367eed71c38c4930a62b07fd5659cbda1b979a61974170ed071"
    "32fac8c96988d24be3c087f19628df42c7801589baf835100d1ffb7fa45a2d09";

}  // namespace

TEST_CASE("hello of protocol 2 is read", "[protocol][golden]") {
  const Message read_back = read(Sender::client, FrameClass::control,
                                 "1000000052554e3108000e000700080008000000000000011800000000001200"
                                 "2c0008000c001800100014000700200012000000000000030200000050000000"
                                 "2800000018000000efcdab896745230105000000000000800000000005000000"
                                 "52656ec3a900000020000000808182838485868788898a8b8c8d8e8f90919293"
                                 "9495969798999a9b9c9d9e9f20000000000102030405060708090a0b0c0d0e0f"
                                 "101112131415161718191a1b1c1d1e1f");
  CHECK(read_back == Message(a_hello()));
}

TEST_CASE("welcome of protocol 2 is read, and its signature holds", "[protocol][golden]") {
  const Message read_back = read(Sender::server, FrameClass::control,
                                 "1000000052554e3108000e000700080008000000000000022c00000000002600"
                                 "640008000c00100044004c000600140018001c00340038003c00400004005400"
                                 "05005c00260000000210200002000000e400000003000000c0ffffffc0000000"
                                 "000000000000e03f0000000000805140000000000000d0bfd000000094000000"
                                 "6c00000024000000e001000000000000f30100000000000040420f0000000000"
                                 "05000000000000004000000069604b4a6c7cd367eed71c38c4930a62b07fd565"
                                 "9cbda1b979a61974170ed07132fac8c96988d24be3c087f19628df42c7801589"
                                 "baf835100d1ffb7fa45a2d0920000000404142434445464748494a4b4c4d4e4f"
                                 "505152535455565758595a5b5c5d5e5f200000008a88e3dd7409f195fd52db2d"
                                 "3cba5d72ca6709bf1d94121bf3748801b40f6f5c100000001011121314151617"
                                 "18191a1b1c1d1e1f02000000340000001000000000000a00100008000c000700"
                                 "0a0000000000000108000000808080ff0500000073746f6e6500060008000400"
                                 "06000000040000000300000061697200",
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
                                 "00000a00180004000c0008000a0000000300000010000000f401000000000000"
                                 "0000000002000000680000001c00000000001600200000000000000007000000"
                                 "100008000c001800160000000000000220000000140000009af1190000000000"
                                 "e00100000000000004000000f503830107000000030207201010030014003400"
                                 "04001000180000002000280008000c0014000000020000003400000028000000"
                                 "88776655443322110900000000000000a0f01900000000009af1190000000000"
                                 "000000000100000001000000070000000100ac0202030600");
  Commit expected;
  expected.epoch = 3;
  expected.first = 500;
  expected.edits.push_back({{2, 0x1122334455667788ULL, 9},
                            Cause::player,
                            1'700'000,
                            1'700'250,
                            {SetVoxel{{1, -2, 3}}, {}, 300},
                            {499},
                            0});
  expected.edits.push_back({{0, 0, 0},
                            Cause::rollback,
                            0,
                            1'700'250,
                            {FillSphere{{16, 8, 8}, 3}, {MaskKind::only_solid, 0}, 7},
                            {0, 370},
                            480});
  CHECK(read_back == Message(expected));
}

TEST_CASE("unavailable chunks of protocol 1 are read", "[protocol][golden]") {
  const Message read_back = read(Sender::server, FrameClass::chunks,
                                 "1000000052554e3108000c000700080008000000000000130c00000008000c00"
                                 "08000700080000000000000104000000020000000000000001000000feffffff"
                                 "0300000000000000fcffffff0000000007000000");
  CHECK(read_back ==
        Message(ChunkUnavailable{{{0, {1, -2, 3}}, {0, {-4, 0, 7}}}, UnavailableReason::damaged}));
}

TEST_CASE("a history request of protocol 2 is read", "[protocol][golden]") {
  const Message read_back =
      read(Sender::client, FrameClass::control,
           "1400000052554e310000000008000c0007000800080000000000001410000000"
           "0c0014000800070000000c000c000000000000020300000040222018240a0600");
  CHECK(read_back == Message(HistoryRequest{3, HistoryTarget::time, 0, 1'700'000'000'123'456}));
}

TEST_CASE("a history state of protocol 2 is read", "[protocol][golden]") {
  const Message read_back = read(Sender::server, FrameClass::chunks,
                                 "1400000052554e310000000008000c0007000800080000000000001514000000"
                                 "10002000080006000700100018000c0010000000000001010300000014000000"
                                 "2c03000000000000c0fd0e18240a06000000000000000000");
  CHECK(read_back ==
        Message(ViewState{3, ViewPhase::begins, true, 812, 1'699'999'999'000'000, ""}));
}

TEST_CASE("a refused history request of protocol 2 is read", "[protocol][golden]") {
  const Message read_back = read(Sender::server, FrameClass::chunks,
                                 "1000000052554e3108000c000700080008000000000000151400000010001000"
                                 "080007000000000000000c001000000000000003040000000400000009000000"
                                 "636f6d706163746564000000");
  CHECK(read_back == Message(ViewState{4, ViewPhase::refused, false, 0, 0, "compacted"}));
}

TEST_CASE("a command of protocol 2 is read", "[protocol][golden]") {
  const Message read_back = read(Sender::client, FrameClass::control,
                                 "1000000052554e3108000c000700080008000000000000160c00000008000c00"
                                 "0400080008000000090000000400000025000000726f6c6c6261636b20707265"
                                 "7669657720617574686f72206d6f6c652073696e6365203268000000");
  CHECK(read_back == Message(CommandRequest{9, "rollback preview author mole since 2h"}));
}

TEST_CASE("the output of a command of protocol 2 is read", "[protocol][golden]") {
  const Message read_back = read(Sender::server, FrameClass::control,
                                 "1000000052554e3108000c00070008000800000000000017100000000c001000"
                                 "08000c00060007000c0000000000010109000000040000000200000018000000"
                                 "04000000090000003433392065646974730000000b0000007072657669657720"
                                 "70313a00");
  CHECK(read_back == Message(CommandOutput{9, {"preview p1:", "439 edits"}, true, true}));
}

TEST_CASE("a change of the player list of protocol 2 is read", "[protocol][golden]") {
  const Message read_back = read(Sender::server, FrameClass::control,
                                 "1000000052554e3108000e0007000800080000000000000f1000000000000a00"
                                 "1000080007000c000a00000000000001080000000c0000000100000018000000"
                                 "02000000080000002c01000008000c0004000800080000000700000004000000"
                                 "03000000626f6200");
  CHECK(read_back == Message(PlayerList{{{7, "bob"}}, true, {8, 300}}));
}

TEST_CASE("cached chunks, unmodified chunks and chunk edits of protocol 2 are read",
          "[protocol][golden]") {
  const CachedChunks held{{{{0, {-3, 0, 7}}, {}, 0x0123456789abcdefULL},
                           {{0, {1, -2, 3}}, {3, 500}, 1},
                           {{0, {1, -2, 4}}, {2, 70}, 0}}};
  CHECK(read(Sender::client, FrameClass::control,
             "1000000052554e3108000e0007000800080000000000001a0c00000000000600"
             "0800040006000000040000002700000005000e00efcdab896745230108030703"
             "f40301000000000000000000020246000000000000000000") == Message(held));
  // The lists are not FlatBuffers, so the encoder's bytes are pinned too.
  CHECK(to_hex(encode_cached_chunks(held.chunks)) ==
        "05000e00efcdab8967452301"
        "08030703f4030100000000000000"
        "00000202460000000000000000");
  const ChunksNotModified same{
      {{{0, {-3, 0, 7}}, 0}, {{0, {1, -2, 3}}, 500}, {{0, {1, -2, 4}}, 70}}};
  CHECK(read(Sender::server, FrameClass::chunks,
             "1000000052554e3108000e0007000800080000000000001b0c00000000000600"
             "0800040006000000040000000e00000005000e00080307e807000002db060000") == Message(same));
  CHECK(to_hex(encode_unmodified(same.chunks)) == "05000e00080307e807000002db06");
  ChunkEdits edits{
      {0, {1, -2, 3}}, 480, {3, 500}, {{0x1d097e98f4fc2824ULL, 0x07cd14195a2e2b9aULL}}, {}};
  edits.edits.push_back({499, {SetVoxel{{17, -31, 50}}, {}, 300}});
  edits.edits.push_back({500, {FillSphere{{20, -30, 50}, 3}, {MaskKind::only_solid, 0}, 7}});
  CHECK(read(Sender::server, FrameClass::chunks,
             "1000000052554e3108000e0007000800080000000000001c1400000000000e00"
             "440004003c001400240038000e0000000000000001000000feffffff03000000"
             "0300000000000000f4010000000000002428fcf4987e091d9a2b2e5a1914cd07"
             "000000000c000000e0010000000000001200000013070100ac02223d64010703"
             "0207283b64030000") == Message(edits));
  CHECK(to_hex(encode_missing_edits(edits.edits, edits.from)) ==
        "13070100ac02223d640107030207283b6403");
}

TEST_CASE("a view of protocol 2 with a direction is read", "[protocol][golden]") {
  const Message read_back = read(Sender::client, FrameClass::control,
                                 "1000000052554e3108000c000700080008000000000000051800000014001800"
                                 "0c001000140004000500060008000a00140000000603004000f0002001000000"
                                 "feffffff03000000");
  CHECK(read_back == Message(View{{1, -2, 3}, 6, 3, 16'384, -4'096, 8'192}));
}

TEST_CASE("a receive ack of protocol 2 is read", "[protocol][golden]") {
  const Message read_back = read(Sender::client, FrameClass::control,
                                 "1000000052554e3108000e000700080008000000000000180c00000000000600"
                                 "0c000400060000008967452301000000");
  CHECK(read_back == Message(ReceiveAck{0x1'2345'6789}));
}

TEST_CASE("uniform chunks of protocol 2 are read", "[protocol][golden]") {
  const Message read_back =
      read(Sender::server, FrameClass::chunks,
           "1000000052554e3108000e000700080008000000000000190c00000000000600"
           "0800040006000000040000000e00000002060301000002000e000703f4030000");
  const std::vector<UniformChunk> chunks = {
      {{0, {1, -2, 3}}, 0, {}}, {{0, {1, -1, 3}}, 0, {}}, {{0, {2, 5, 3}}, 7, {3, 500}}};
  CHECK(read_back == Message(UniformChunks{chunks}));
}

TEST_CASE("handshake transcripts and signatures are pinned", "[protocol][golden]") {
  Hello hello = a_hello();
  hello.key = keys_of(2).public_key;
  const Welcome welcome = a_welcome();
  const Bytes transcript = server_transcript(hello, welcome);
  CHECK(
      to_hex(transcript) ==
      to_hex(from_hex(
          "12000000 72756e73746f6e6520736572766572207631"  // "runstone server v1"
          "04000000 02000000"                              // hello.protocol
          "20000000 8139770ea87d175f56a35466c34c7ecccb8d8a91b4ee37a25df60f5b8fc9b394"  // hello.key
          "08000000 efcdab8967452301"  // hello.instance
          // hello.nonce
          "20000000 808182838485868788898a8b8c8d8e8f909192939495969798999a9b9c9d9e9f"
          "05000000 52656ec3a9"                        // hello.name
          "01000000 03"                                // hello.encodings
          "08000000 0500000000000080"                  // hello.features
          "04000000 02000000"                          // welcome.protocol
          "10000000 101112131415161718191a1b1c1d1e1f"  // world_id
          "04000000 03000000"                          // epoch
          "08000000 e001000000000000"                  // durable
          "08000000 f301000000000000"                  // head
          "02000000 2000"                              // chunk_edge
          "04000000 c0ffffff"                          // y_min
          "04000000 c0000000"                          // y_max
          "08000000 000000000000e03f 08000000 0000000000805140 08000000 000000000000d0bf"  // spawn
          "04000000 02000000"                                                              // rows
          "03000000 616972 04000000 00000000 01000000 00"                                  // air
          "05000000 73746f6e65 04000000 808080ff 01000000 01"                              // stone
          "20000000 8a88e3dd7409f195fd52db2d3cba5d72ca6709bf1d94121bf3748801b40f6f5c"  // server_key
          "20000000 404142434445464748494a4b4c4d4e4f505152535455565758595a5b5c5d5e5f"  // challenge
          "01000000 02"                                                                // encoding
          "08000000 40420f0000000000"      // edit_volume_max
          "01000000 10"                    // view_radius_max
          "08000000 0500000000000000")));  // welcome.features
  CHECK(to_hex(transcript) == transcript_of_the_page());
  CHECK(to_hex(sign(keys_of(1), transcript)) == kServerSignature);
  CHECK(to_hex(sign(keys_of(2), client_transcript(hello, welcome))) ==
        "84d50dc41accf04644e3a969534a705651518dc6c2c2cd7d34b8e369dc13382c"
        "9e13b6b6526400ad6a3409e276a808d29fcaae28726c2ea4b842f5c9e139540d");
}

}  // namespace runstone::test
