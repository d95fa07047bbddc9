#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "protocol/codec/handshake.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"
#include "tests/support/hex.hpp"
#include "tests/support/page_example.hpp"

// Messages as version 2 of the protocol wrote them. How they are decoded must never change.
// Releases of FlatBuffers may arrange fields differently, so the encoder's bytes are not pinned.
// The byte lists inside are pinned by list_bytes_test.cpp.
namespace runstone::test {
namespace {

constexpr std::uint16_t kChunkEdge = 16;

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
  m.edit_budget = {100, 4'000};
  m.view_radius_max = 16;
  m.features = 5;
  return m;
}

Signature signature_of(const char* hex) {
  Signature signature;
  const Bytes bytes = from_hex(hex);
  std::copy(bytes.begin(), bytes.end(), signature.begin());
  return signature;
}

PublicKey key_from(std::uint8_t first) {
  PublicKey key;
  for (std::size_t i = 0; i < key.size(); ++i) key[i] = static_cast<std::uint8_t>(first + i);
  return key;
}

constexpr const char* kServerSignature =
    "d0b130d035d47ca403d7c40fe190cb0a1b4a8d58fbef99a938fd6a5b766784c2"
    "870800cedb5f9126ed3bd9d47ab11bc7c55a8fe429bf35dd1138d4bce1bb4206";
constexpr const char* kClientSignature =
    "f15ec6aea8b7891b16dbba402be7e5af49e9feedc34dfa72f493b677296a2a57"
    "23fbd7570cedb382866bb9b9b99f0caaf84345fb7ca1ee15e703b0e2400c8105";

/// The channel binding of the protocol page: c0, c1 and so on.
std::optional<ChannelBinding> page_binding() {
  ChannelBinding binding{};
  std::iota(binding.begin(), binding.end(), std::uint8_t{0xc0});
  return binding;
}

Welcome signed_welcome() {
  Welcome m = a_welcome();
  m.signature = signature_of(kServerSignature);
  return m;
}

/// A welcome whose signature is left out, because it would not hold for the salt.
Welcome welcome_with_password() {
  Welcome m = a_welcome();
  m.password_salt = counting<16>(0xa0);
  return m;
}

Welcome welcome_with_few_levels() {
  Welcome m = signed_welcome();
  m.tile_levels_max = 5;
  return m;
}

Commit a_commit() {
  Commit m;
  m.epoch = 3;
  m.edits.push_back({500,
                     {2, 0x1122334455667788ULL, 9},
                     Cause::player,
                     1'700'000,
                     1'700'250,
                     {SetVoxel{{1, -2, 3}}, {}, 300},
                     {499},
                     0});
  m.edits.push_back({503,
                     {0, 0, 0},
                     Cause::rollback,
                     1'700'250,
                     1'700'250,
                     {FillSphere{{16, 8, 8}, 3}, {MaskKind::only_solid, 0}, 7},
                     {0, 370},
                     480});
  return m;
}

Chunks some_chunks() {
  const RunChunk voxels = uniform_chunk(Extent::cube(kChunkEdge), 7, AxisOrder::yxz);
  const ChunkSnapshot snapshot{{0, {1, -2, 2}}, {voxels, {3, 500}, digest_of(voxels)}};
  ChunkEdits edits{{0, {1, -2, 3}}, 499, {3, 500}, {{1, 2}}, {}};
  edits.edits.push_back({500, {SetVoxel{{17, -31, 50}}, {}, 300}});
  return {12, {snapshot, edits}};
}

struct GoldenMessage {
  Message message;
  const char* hex;
};

std::vector<GoldenMessage> golden_messages() {
  const Pose pose{{0.5, 70, -0.25}, 16'384, -4'096};
  return {
      {a_hello(),
       "18000000000012002c0008000c00180010001400070020001200000000000003"
       "02000000500000002800000018000000efcdab89674523010500000000000080"
       "000000000500000052656ec3a900000020000000808182838485868788898a8b"
       "8c8d8e8f909192939495969798999a9b9c9d9e9f200000000001020304050607"
       "08090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f"},
      {signed_welcome(),
       "340000000000000000002a00740008000c00100044004c000600140018001c00"
       "340038003c004000040054005c00640005006c002a0000000210200002000000"
       "f400000003000000c0ffffffc0000000000000000000e03f0000000000805140"
       "000000000000d0bfe0000000a40000007c00000034000000e001000000000000"
       "f30100000000000040420f00000000006400000000000000a00f000000000000"
       "050000000000000040000000d0b130d035d47ca403d7c40fe190cb0a1b4a8d58"
       "fbef99a938fd6a5b766784c2870800cedb5f9126ed3bd9d47ab11bc7c55a8fe4"
       "29bf35dd1138d4bce1bb420620000000404142434445464748494a4b4c4d4e4f"
       "505152535455565758595a5b5c5d5e5f200000008a88e3dd7409f195fd52db2d"
       "3cba5d72ca6709bf1d94121bf3748801b40f6f5c100000001011121314151617"
       "18191a1b1c1d1e1f02000000340000001000000000000a00100008000c000700"
       "0a0000000000000108000000808080ff0500000073746f6e6500060008000400"
       "06000000040000000300000061697200"},
      {ClientAuth{signature_of(kClientSignature), {}, {}},
       "0c0000000000060008000400060000000400000040000000f15ec6aea8b7891b"
       "16dbba402be7e5af49e9feedc34dfa72f493b677296a2a5723fbd7570cedb382"
       "866bb9b9b99f0caaf84345fb7ca1ee15e703b0e2400c8105"},
      {SessionAccepted{7, 41}, "1000000000000000080010000400080008000000070000002900000000000000"},
      {View{12, {1, -2, 3}, 6, 3, 16'384, -4'096, 8'192},
       "1c000000000016001c000c0010001400180004000500060008000a0016000000"
       "0603004000f000200c00000001000000feffffff03000000"},
      {ChunkRequest{{{0, {-3, 0, 7}}, {0, {1, -2, 3}}, {0, {1, -2, 4}}}},
       "0c000000000006000800040006000000040000000900000005000e0803070000"
       "02000000"},
      {some_chunks(),
       "0c00000008000c0004000800080000000c000000040000004a00000002030400"
       "03f403554d34f7cccaed01501bda02cff5970310010102001010100001000000"
       "001007000000020103f403010000000000000002000000000000000109010701"
       "00ac02223d640000"},
      {EditRequest{7,
                   1'700'000,
                   {FillBox{{{-1, 0, 100}, {0, 32, 4196}}}, {MaskKind::only_material, 65535}, 0}},
       "1000000000000a001c000800100004000a000000180000000700000000000000"
       "a0f0190000000000000000000e0000000203ffff03000100c801001fff1f0000"},
      {a_commit(),
       "0c00000008000c00040008000800000003000000040000003b000000f403b4c6"
       "cf01028877665544332211090000f403070100ac020203060101030000000000"
       "00000000000002e00300070302072010100302f703850100"},
      {Reject{7, RejectReason::outside_world, "y 192 is above the world"},
       "140000000000000000000a0014000c00070008000a000000000000090c000000"
       "07000000000000001800000079203139322069732061626f7665207468652077"
       "6f726c6400000000"},
      {Reject{7, RejectReason::already_resolved, "", 512},
       "14000000000000000c001c000c000700080014000c0000000000000214000000"
       "070000000000000000020000000000000000000000000000"},
      {Durable{3, 500}, "100000000000000008001000040008000800000003000000f401000000000000"},
      {DigestCheck{{{{0, {1, -2, 3}}, {3, 500}, {{1, 2}}}, {{0, {1, -2, 4}}, {}, {}}}},
       "0c000000000006000800040006000000040000002a00000002030603f4030100"
       "0000000000000200000000000000000002000000000000000000000000000000"
       "00000000"},
      {Move{pose},
       "0c000000000006002400040006000000000000000000e03f0000000000805140"
       "000000000000d0bf004000f000000000"},
      {PlayerPoses{{{7, pose}, {8, {}}}},
       "0c00000000000600080004000600000004000000020000003800000004000000"
       "d8ffffff08000000000000000000000000000000000000000000000000000000"
       "000000000000000008002800040008000800000007000000000000000000e03f"
       "0000000000805140000000000000d0bf004000f000000000"},
      {PlayerList{{{7, "bob", key_from(0)}}, true, {8, 300}},
       "1000000000000a001000080007000c000a00000000000001080000000c000000"
       "010000001c00000002000000080000002c01000000000a001000040008000c00"
       "0a000000070000002c0000000400000020000000000102030405060708090a0b"
       "0c0d0e0f101112131415161718191a1b1c1d1e1f03000000626f6200"},
      {PlayerList{{{7, "bob", key_from(0)}, {8, "ann", key_from(0x40)}}, false, {}},
       "0c00000000000600080004000600000004000000020000005000000004000000"
       "c2ffffff080000002c0000000400000020000000404142434445464748494a4b"
       "4c4d4e4f505152535455565758595a5b5c5d5e5f03000000616e6e0000000a00"
       "1000040008000c000a000000070000002c000000040000002000000000010203"
       "0405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f03000000"
       "626f6200"},
      {Ping{1'700'000}, "0c000000000006000c00040006000000a0f0190000000000"},
      {Pong{1'700'000, -5}, "0c0000000800140004000c0008000000a0f0190000000000fbffffffffffffff"},
      {Goodbye{GoodbyeReason::server_full, "32 players"},
       "0c00000008000c00060008000800000000000800040000000a00000033322070"
       "6c61796572730000"},
      {ChunkUnavailable{12, {{0, {-4, 0, 7}}, {0, {1, -2, 3}}}, UnavailableReason::damaged},
       "1000000000000a00100008000c0007000a000000000000010c00000004000000"
       "0600000007000e0a03070000"},
      {HistoryRequest{3, HistoryTarget::time, 0, 1'700'000'000'123'456},
       "14000000000000000c0014000800070000000c000c0000000000000203000000"
       "40222018240a0600"},
      {ViewState{3, 12, ViewPhase::begins, true, 812, 1'699'999'999'000'000, ""},
       "1c0000000000000000001200240008000c000600070014001c00100012000000"
       "00000101030000000c000000140000002c03000000000000c0fd0e18240a0600"
       "0000000000000000"},
      {ViewState{4, 12, ViewPhase::refused, true, 812, 1'699'999'999'000'000, "compacted"},
       "1c0000000000000000001200240008000c000600070014001c00100012000000"
       "00000301040000000c000000140000002c03000000000000c0fd0e18240a0600"
       "09000000636f6d706163746564000000"},
      {ViewState{0, 12, ViewPhase::complete, false, 0, 0, ""},
       "180000000000120010000000080007000000000000000c001200000000000002"
       "0c000000040000000000000000000000"},
      {CommandRequest{9, "rollback preview author mole since 2h"},
       "0c00000008000c000400080008000000090000000400000025000000726f6c6c"
       "6261636b207072657669657720617574686f72206d6f6c652073696e63652032"
       "68000000"},
      {CommandOutput{9, {"preview p1:", "439 edits"}, true, true},
       "100000000c00100008000c00060007000c000000000001010900000004000000"
       "020000001800000004000000090000003433392065646974730000000b000000"
       "707265766965772070313a00"},
      {ReceiveAck{0x1'2345'6789}, "0c000000000006000c000400060000008967452301000000"},
      {UniformChunks{
           12, {{{0, {1, -2, 3}}, 0, {}}, {{0, {1, -2, 4}}, 0, {}}, {{0, {2, 5, 3}}, 7, {3, 500}}}},
       "0c00000008000c0004000800080000000c000000040000000e00000002030601"
       "0000020e00000703f4030000"},
      {CachedChunks{{{{0, {-3, 0, 7}}, {}, 0x0123456789abcdefULL}, {{0, {1, -2, 3}}, {3, 500}, 1}}},
       "0c000000000006000800040006000000040000001a00000005000e00efcdab89"
       "6745230108030703f40301000000000000000000"},
      {ChunksNotModified{12, {{{0, {-3, 0, 7}}, 0}, {{0, {1, -2, 3}}, 500}}},
       "0c00000008000c0004000800080000000c000000040000000900000005000e00"
       "080307e807000000"},
      {Permissions{"builder", 0x4b, 1000, ""},
       "100000000c001c000400080010000c000c000000200000004b00000010000000"
       "e803000000000000000000000000000000000000070000006275696c64657200"},
      {Permissions{"builder", 1, 0, "you may not edit: griefing"},
       "100000000c0010000400080000000c000c0000002c0000000100000004000000"
       "1a000000796f75206d6179206e6f7420656469743a206772696566696e670000"
       "070000006275696c64657200"},
      {ProtectedGround{{5, 812},
                       {{900, {{-8, 0, 16}, {8, 64, 32}}, -3, true, "spawn", "ann"},
                        {901, {{0, 0, 0}, {1, 1, 1}}, 0, false, "plot.7", ""}}},
       "0c00000008000c00040008000800000014000000040000000200000088000000"
       "2c0000000200000005000000000000002c030000000000000000120030002400"
       "04001000000000001c0020001200000000000000000000000000000001000000"
       "01000000010000001c0000001000000085030000000000000000000000000000"
       "0000000006000000706c6f742e3700000000120038002c000800140020000700"
       "240028001200000000000001f8ffffff00000000100000000800000040000000"
       "20000000fdffffff1c0000001000000084030000000000000000000003000000"
       "616e6e0005000000737061776e000000"},
      {welcome_with_password(),
       "34000000000000002c00800008000c0010004c0054000600140018001c003800"
       "3c004000440004005c0064006c000500740048002c0000000210200002000000"
       "1401000003000000c0ffffffc0000000000000000000e03f0000000000805140"
       "000000000000d0bf00000000fc000000c0000000980000005000000038000000"
       "e001000000000000f30100000000000040420f00000000006400000000000000"
       "a00f00000000000005000000000000000000000010000000a0a1a2a3a4a5a6a7"
       "a8a9aaabacadaeaf400000000000000000000000000000000000000000000000"
       "0000000000000000000000000000000000000000000000000000000000000000"
       "00000000000000000000000020000000404142434445464748494a4b4c4d4e4f"
       "505152535455565758595a5b5c5d5e5f200000008a88e3dd7409f195fd52db2d"
       "3cba5d72ca6709bf1d94121bf3748801b40f6f5c100000001011121314151617"
       "18191a1b1c1d1e1f02000000340000001000000000000a00100008000c000700"
       "0a0000000000000108000000808080ff0500000073746f6e6500060008000400"
       "06000000040000000300000061697200"},
      {welcome_with_few_levels(),
       "380000000000000000002e0078000c0010001400480050000a0018001c002000"
       "38003c0040004400070058006000680008007000000009002e00000000000002"
       "1005200002000000f400000003000000c0ffffffc0000000000000000000e03f"
       "0000000000805140000000000000d0bfe0000000a40000007c00000034000000"
       "e001000000000000f30100000000000040420f00000000006400000000000000"
       "a00f000000000000050000000000000040000000d0b130d035d47ca403d7c40f"
       "e190cb0a1b4a8d58fbef99a938fd6a5b766784c2870800cedb5f9126ed3bd9d4"
       "7ab11bc7c55a8fe429bf35dd1138d4bce1bb4206200000004041424344454647"
       "48494a4b4c4d4e4f505152535455565758595a5b5c5d5e5f200000008a88e3dd"
       "7409f195fd52db2d3cba5d72ca6709bf1d94121bf3748801b40f6f5c10000000"
       "101112131415161718191a1b1c1d1e1f02000000340000001000000000000a00"
       "100008000c0007000a0000000000000108000000808080ff0500000073746f6e"
       "650006000800040006000000040000000300000061697200"},
      {ClientAuth{signature_of(kClientSignature), {}, counting<32>(0x60)},
       "1000000000000a000c000400000008000a0000002c0000000400000020000000"
       "606162636465666768696a6b6c6d6e6f707172737475767778797a7b7c7d7e7f"
       "40000000f15ec6aea8b7891b16dbba402be7e5af49e9feedc34dfa72f493b677"
       "296a2a5723fbd7570cedb382866bb9b9b99f0caaf84345fb7ca1ee15e703b0e2"
       "400c8105"},
      {ChatRequest{"hello"}, "0c000000000006000800040006000000040000000500000068656c6c6f000000"},
      {ChatLines{{{ChatLineKind::player, 7, "ann", "hi", 1'700'000'000'000'000},
                  {ChatLineKind::server, 0, "", "back in five minutes", 1'700'000'000'000'001}}},
       "1000000000000000000006000800040006000000040000000200000058000000"
       "1400000000000e00180007000000000008000c000e0000000000000210000000"
       "01401e18240a060000000000140000006261636b20696e2066697665206d696e"
       "7574657300000e001c00070008000c00100014000e0000000000000107000000"
       "180000000c00000000401e18240a0600020000006869000003000000616e6e00"},
      {KeyRequest{counting<16>(0x20)},
       "0c00000000000600080004000600000004000000100000002021222324252627"
       "28292a2b2c2d2e2f"},
      {SealedKey{{1, 2, 3}}, "0c000000000006000800040006000000040000000300000001020300"},
      {KeyDeposit{counting<16>(0x20), {1, 2, 3}, signature_of(kClientSignature)},
       "1000000000000a001000040008000c000a000000580000004c00000004000000"
       "40000000f15ec6aea8b7891b16dbba402be7e5af49e9feedc34dfa72f493b677"
       "296a2a5723fbd7570cedb382866bb9b9b99f0caaf84345fb7ca1ee15e703b0e2"
       "400c8105030000000102030010000000202122232425262728292a2b2c2d2e2f"},
      {KeyDeposited{600, ""}, "0c00000008000c00040008000800000058020000040000000000000000000000"},
      {KeyDeposited{0, "too many keys wait"},
       "0c0000000800080000000400080000000400000012000000746f6f206d616e79"
       "206b65797320776169740000"},
      {MaterialsAdded{24,
                      {{"lamp", {255, 240, 200, 255}, Visibility::opaque},
                       {"oil", {20, 20, 10, 250}, Visibility::transparent, MaterialBody::liquid}}},
       "0c00000008000c00040008000800000018000000040000000200000038000000"
       "100000000c00100008000c00060007000c000000000002010800000014140afa"
       "030000006f696c0000000a00100008000c0007000a0000000000000108000000"
       "fff0c8ff040000006c616d7000000000"},
      {PlayerList{{{7, "bob", {}, "moderator"}}, false, {}},
       "0c0000000000060008000400060000000400000001000000100000000c001400"
       "040008000c0010000c0000000700000040000000180000000400000009000000"
       "6d6f64657261746f720000002000000000000000000000000000000000000000"
       "0000000000000000000000000000000003000000626f6200"},
      {LogMarksRequest{3, 1, 0x1'2345'6789, 128},
       "14000000000000000c001c0008000c00140007000c0000000000008003000000"
       "01000000000000008967452301000000"},
      {LogMarks{3,
                5,
                {{5, 1'700'000'000'000'000, 7, Cause::player, EditKind::fill_box},
                 {812, 1'700'000'100'000'000, 0, Cause::rollback, EditKind::paste}},
                {{7, "ann"}},
                ""},
       "1400000000000e0020000400140008000c0010000e0000000300000028000000"
       "1c00000010000000050000000000000000000000000000000000000001000000"
       "4400000002000000050000000000000000401e18240a06000700000000020000"
       "2c030000000000000021141e240a060000000000020600000000000008000c00"
       "0400080008000000070000000400000003000000616e6e00"},
      {LogMarks{4, 1, {}, {}, "your role does not allow to see the past"},
       "1400000000000e001c000400140008000c0010000e0000000400000048000000"
       "400000000c000000010000000000000028000000796f757220726f6c6520646f"
       "6573206e6f7420616c6c6f7720746f2073656520746865207061737400000000"
       "0000000000000000"},
      {RestorePreview{9,
                      "p1",
                      4096,
                      2,
                      {{SetVoxel{{1, -2, 3}}, {}, 4},
                       {FillBox{{{-8, 0, 16}, {8, 64, 32}}}, {MaskKind::only_solid, kEmpty}, 0}},
                      true},
       "140000001000280008000c0014001c0010000700100000000000000109000000"
       "2800000018000000001000000000000002000000000000000000000002000000"
       "2c0000000c0000000200000070310000eaffffff04000000090000000202000f"
       "00200f3f0f000600080004000600000004000000060000000100040203060000"},
      {PreviewShare{{{SetVoxel{{1, 2, 3}}, {}, 1},
                     {FillSphere{{-1, 0, 100}, 3}, {MaskKind::only_empty, 0}, 0}}},
       "0c00000000000600080004000600000004000000100000000601000102040608"
       "0301000100c80103"},
      {PreviewShare{}, "0c0000000000060008000400060000000400000000000000"},
      {PlayerPreview{7, {{SetVoxel{{1, 2, 3}}, {}, 1}}},
       "0c00000008000c00040008000800000007000000040000000700000006010001"
       "02040600"},
      {EditRequest{7, 1'700'000, {SetVoxel{{1, 2, 3}}, {}, 1}, std::nullopt, 5},
       "100000000c00240008001000040018000c000000200000000700000000000000"
       "a0f0190000000000050000000000000000000000060000000100010204060000"},
      {View{12, {1, -2, 3}, 6, 3, 0, 0, 0, 5},
       "1c0000001800180008000c001000140005000600000000000000070018000000"
       "000603050c00000001000000feffffff03000000"},
      {UniformChunks{3, {{{2, {1, -2, 3}}, 0, {}}, {{2, {2, 5, 3}}, 7, {3, 500}}}},
       "1000000000000a00100008000c0007000a000000000000020300000004000000"
       "0e000000020306000000020e00000703f4030000"},
      {CachedChunks{{{{2, {-3, 0, 7}}, {}, 0x0123456789abcdefULL}, {{2, {1, -2, 3}}, {3, 500}, 1}}},
       "0c00000008000c00080007000800000000000002040000001a00000005000e00"
       "efcdab896745230108030703f40301000000000000000000"},
      {ChunksNotModified{12, {{{2, {-3, 0, 7}}, 0}, {{2, {1, -2, 3}}, 500}}},
       "1000000000000a00100008000c0007000a000000000000020c00000004000000"
       "0900000005000e00080307e807000000"},
      {SessionAccepted{7, 41, 3},
       "140000000000000000000a00140004000c0008000a0000000700000003000000"
       "2900000000000000"},
      {MaterialsAdded{24,
                      {{"lamp",
                        {255, 240, 200, 255},
                        Visibility::opaque,
                        MaterialBody::solid,
                        MaterialLook{2, 6, 60, 100, MaterialPattern::tiles}}}},
       "0c00000008000c00040008000800000018000000040000000100000014000000"
       "00000e00180008000c000700000013000e0000000000000110000000fff0c8ff"
       "00000002063c6403040000006c616d7000000000"},
  };
}

}  // namespace

TEST_CASE("messages of version 2 are read", "[protocol][golden]") {
  std::set<MessageKind> kinds;
  for (const GoldenMessage& golden : golden_messages()) {
    const MessageKind kind = golden.message.index();
    CAPTURE(info_of(kind).name);
    const Sender sender = may_send(info_of(kind), Sender::client) ? Sender::client : Sender::server;
    const auto decoded = decode_message(sender, kind, from_hex(golden.hex), kChunkEdge);
    if (!decoded) FAIL(decoded.error().what);
    CHECK(*decoded == golden.message);
    kinds.insert(kind);
  }
  CHECK(kinds.size() == kMessageKindCount);
}

TEST_CASE("the signature of a recorded welcome holds", "[protocol][golden]") {
  Hello hello = a_hello();
  hello.key = keys_of(2).public_key;
  const Welcome welcome = signed_welcome();
  CHECK(verify(welcome.server_key, server_transcript(hello, welcome, page_binding()),
               welcome.signature));
}

TEST_CASE("handshake transcripts and signatures are those of the protocol page",
          "[protocol][golden]") {
  Hello hello = a_hello();
  hello.key = keys_of(2).public_key;
  const Welcome welcome = a_welcome();
  const Bytes transcript = server_transcript(hello, welcome, page_binding());
  CHECK(to_hex(transcript) == page_example("transcript"));
  CHECK(to_hex(sign(keys_of(1), transcript)) == kServerSignature);
  CHECK(to_hex(sign(keys_of(2), client_transcript(hello, welcome, page_binding()))) ==
        kClientSignature);
  CHECK(page_example("signatures") == std::string(kServerSignature) + kClientSignature);
}

TEST_CASE("the framed message of the protocol page is read", "[protocol][golden]") {
  FrameReader reader(Sender::client);
  int count = 0;
  const auto fed = reader.feed(
      from_hex(page_example("view-frame")), [&](MessageKind kind, ByteView bytes) -> Result<void> {
        const auto decoded = decode_message(Sender::client, kind, bytes, kChunkEdge);
        if (!decoded) return Unexpected<Error>{decoded.error()};
        CHECK(*decoded == Message(View{12, {1, -2, 3}, 6, 3}));
        ++count;
        return {};
      });
  REQUIRE(fed.has_value());
  CHECK(count == 1);
}

}  // namespace runstone::test
