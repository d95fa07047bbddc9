#include <catch2/catch.hpp>
#include <string_view>
#include <vector>

#include "common/veil/veil.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/limits.hpp"
#include "tests/support/core/hex.hpp"

// The additions of version 3 of the protocol. They may change until version 3 is released.
namespace runstone::test {
namespace {

static_assert(kMessageKindCount == 66, "a kind that is added needs golden bytes here");

VeiledCommit golden_veiled_commit() {
  VeiledCommit commit{3, {{}}};
  VeiledEdit& edit = commit.edits[0];
  edit.ordered = {500,       {2, 0x1122334455667788, 9},      Cause::player, 1'700'000,
                  1'700'250, {SetVoxel{{1, -2, 3}}, {}, 300}, {499},         0};
  edit.has_edit = true;
  edit.patches = {{{0, -1, 0}, 500, {Extent::cube(16), kVeilOrder, {{5, 1, 7}}}}};
  return commit;
}

VeilPatches golden_veil_patches() {
  const VeilPatch patch{Extent::cube(16), kVeilOrder, {{5, 2, 7}, {9, 1, 7}}};
  return {{3, 500}, {{{0, -1, 0}, 480, patch}}};
}

Builds golden_builds() {
  ListedBuild mill;
  mill.number = 811;
  mill.info.name = "Mill";
  mill.info.author = "Ann";
  mill.info.tags = {"mill", "wood"};
  mill.info.created_us = 1'700'000'000'000'000;
  mill.info.sides = {70, 30, 20};
  mill.info.origin = {-8, 64, 100};
  mill.touched = 12'345;
  mill.file_bytes = 4'096;
  mill.added_by = 7;
  mill.added_by_name = "ann";
  ListedBuild small;
  small.number = 5;
  small.info.name = "a";
  return {3, {mill, small}, true, 9, ""};
}

/// Returns the hash 1, 2, 3, ..., 32.
TextureHash counted_hash() {
  TextureHash hash{};
  for (std::size_t i = 0; i < hash.size(); ++i) hash[i] = static_cast<std::uint8_t>(i + 1);
  return hash;
}

struct GoldenOfVersion3 {
  Message message;
  std::string_view hex;
};

std::vector<GoldenOfVersion3> messages_of_version_3() {
  return {
      {BuildsRequest{3, "mill", "ann", "wood", 812, 20},
       "18000000000000001000200008000c0010001400180007001000000000000014"
       "03000000280000001c0000000c0000002c0300000000000004000000776f6f64"
       "0000000003000000616e6e00040000006d696c6c00000000"},
      {golden_builds(),
       "1400000000000e001c0008000c000700140010000e0000000000000103000000"
       "180000000c000000090000000000000000000000000000000200000054000000"
       "100000000c00200008000400100018000c0000001c0000000500000000000000"
       "010000000000000001000000000000000b000000000000000000000161000000"
       "10002800100004001800200008000c00100000002c000000070000001c000000"
       "2b030000000000003930000000000000001000000000000003000000616e6e00"
       "24000000451d130f8001c8018080f9c0c1c48203044d696c6c03416e6e02046d"
       "696c6c04776f6f64"},
      {Builds{4, {}, false, 9, "your role does not allow to see"},
       "180000000000000000000e00180004000800000010000c000e00000004000000"
       "340000000c00000009000000000000001f000000796f757220726f6c6520646f"
       "6573206e6f7420616c6c6f7720746f207365650000000000"},
      {BuildPieceRequest{4, 811, 65'536},
       "1000000000000a0018000400080010000a000000040000002b03000000000000"
       "0000010000000000"},
      {BuildPiece{4, {1, 2, 3}, ""},
       "1000000000000a001000040008000c000a000000040000001000000004000000"
       "00000000000000000300000001020300"},
      {BuildPiece{5, {}, "no such build"},
       "1000000000000a001000040008000c000a000000050000001c00000004000000"
       "0d0000006e6f2073756368206275696c6400000000000000"},
      {BuildOffer{6, 70'000}, "1000000000000000080010000400080008000000060000007011010000000000"},
      {BuildUpload{6, 32'768, {1, 2, 3}},
       "140000000000000000000a00140004000c0008000a000000060000000c000000"
       "00800000000000000300000001020300"},
      {BuildAnswer{6, 70'000, 812, ""},
       "14000000000000000c001c0004000c00140008000c0000000600000014000000"
       "70110100000000002c030000000000000000000000000000"},
      {ShapesGiven{{{{5, {ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}}},
                     {300, {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}}},
                     {301, {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}}}}}},
       "0c0000000000060008000400060000000400000013000000010001f070f00101"
       "e1b0e1020401a60200000000"},
      {TexturesGiven{{{counted_hash(), 300, {{5, 63}, {300, 4}}}}},
       "0c000000000006000800040006000000040000002e0000000100010203040506"
       "0708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f202c0100000200"
       "05003f2c01040000"},
      {TexturesWanted{{counted_hash()}},
       "0c00000000000600080004000600000004000000200000000102030405060708"
       "090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f20"},
      {TextureParts{{{counted_hash(), {7, 8, 9}}}},
       "0c00000000000600080004000600000004000000250000000102030405060708"
       "090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f200300070809000000"},
      {WorldTime{75'600'000, 20}, "0c00000008000c0004000800080000008090810414000000"},
      {ChatWithdrawn{{{1'700'000'000'000'000, "ann"}, {-5, "bea"}}},
       "0c00000000000600080004000600000004000000020000002800000004000000"
       "e8ffffff0c000000fbffffffffffffff03000000626561000800100008000400"
       "080000000c00000000401e18240a060003000000616e6e00"},
      {golden_veiled_commit(),
       "0c00000008000c000400080008000000030000000400000028000000f403b4c6"
       "cf01028877665544332211090000f403070100ac020203060101010001000004"
       "01050007"},
      {golden_veil_patches(),
       "140000000000000000000a00140004000c0008000a000000030000000c000000"
       "f4010000000000000b000000000100140602050207020100"},
      {SessionAccepted{7, 41, 3, Pose{{1.5, -2, 3}, 16384, -8192}},
       "14000000000000000c00340004002c0008000c000c0000000700000003000000"
       "000000000000f83f00000000000000c00000000000000840004000e000000000"
       "2900000000000000"},
      {LogMarksRequest{3, 1, 0x1'2345'6789, 128, VoxelPos{1, -2, 0x123'4567}},
       "180000000000000000000e00280008001800200007000c000e00000000000080"
       "0300000001000000feffffff6745230101000000000000008967452301000000"},
      {BuildAnswer{6, 100, 0, "the library is full"},
       "14000000000000000c00140004000c00000008000c000000060000000c000000"
       "640000000000000013000000746865206c6962726172792069732066756c6c00"},
  };
}

}  // namespace

TEST_CASE("the features of version 3 have their numbers", "[protocol][golden]") {
  CHECK(kFeatureTimeCorrections == 1 << 14);
  CHECK(kFeatureLargeActions == 1 << 15);
  CHECK(kFeatureLibrary == 1 << 16);
  CHECK(kFeatureBuilds == 1 << 17);
  CHECK(kFeatureShapes == 1 << 18);
  CHECK(kFeatureShapeRecords == 1 << 19);
  CHECK(kFeatureTextures == 1 << 20);
  CHECK(kFeatureTextureRecords == 1 << 21);
  CHECK(kFeatureWorldTime == 1 << 22);
  CHECK(kFeatureClockRecords == 1 << 23);
  CHECK(kFeatureVisits == 1 << 24);
  CHECK(kFeatureVoxelAuthors == 1 << 25);
  CHECK(kFeatureVeil == 1 << 26);
  CHECK(kFeatureChatWithdrawal == 1 << 27);
  CHECK(kFeatureTimedGrants == 1 << 28);
  CHECK(kFeatureStrokes == 1 << 30);
}

TEST_CASE("the kinds of version 3 have their numbers", "[protocol][golden]") {
  CHECK(wire_number(kKindOf<BuildsRequest>) == 52);
  CHECK(wire_number(kKindOf<Builds>) == 53);
  CHECK(wire_number(kKindOf<BuildPieceRequest>) == 54);
  CHECK(wire_number(kKindOf<BuildPiece>) == 55);
  CHECK(wire_number(kKindOf<BuildOffer>) == 56);
  CHECK(wire_number(kKindOf<BuildUpload>) == 57);
  CHECK(wire_number(kKindOf<BuildAnswer>) == 58);
  CHECK(wire_number(kKindOf<ShapesGiven>) == 59);
  CHECK(wire_number(kKindOf<TexturesGiven>) == 60);
  CHECK(wire_number(kKindOf<TexturesWanted>) == 61);
  CHECK(wire_number(kKindOf<TextureParts>) == 62);
  CHECK(wire_number(kKindOf<WorldTime>) == 63);
  CHECK(wire_number(kKindOf<ChatWithdrawn>) == 64);
  CHECK(wire_number(kKindOf<VeiledCommit>) == 65);
  CHECK(wire_number(kKindOf<VeilPatches>) == 66);
}

TEST_CASE("the reasons of version 3 have their numbers", "[protocol][golden]") {
  CHECK(static_cast<int>(RejectReason::unknown_action) == 10);
  CHECK(static_cast<int>(RejectReason::action_ended) == 11);
}

TEST_CASE("messages with the additions of version 3 decode", "[protocol][golden]") {
  const Message optional =
      EditRequest{7, 1'700'000, {SetVoxel{{1, 2, 3}}, {}, 1}, std::nullopt, 5, true};
  CHECK(*decode_message(
            Sender::client, kKindOf<EditRequest>,
            from_hex(
                "1400000000000e0028000c00140008001c0007000e00000000000001200000000700000000000000"
                "a0f0190000000000050000000000000000000000060000000100010204060000"),
            16) == optional);
  const Message unknown = Reject{7, RejectReason::unknown_action, "", 0};
  CHECK(*decode_message(
            Sender::server, kKindOf<Reject>,
            from_hex(
                "140000000000000000000a0014000c00070008000a0000000000000a0c00000007000000000000000"
                "00000000000000000"),
            16) == unknown);
}

TEST_CASE("messages of version 3 are read", "[protocol][golden]") {
  for (const GoldenOfVersion3& golden : messages_of_version_3()) {
    const MessageInfo& info = info_of(golden.message);
    CAPTURE(info.name);
    const Sender sender = may_send(info, Sender::client) ? Sender::client : Sender::server;
    const auto decoded = decode_message(sender, golden.message.index(), from_hex(golden.hex), 16);
    if (!decoded) FAIL(decoded.error().what);
    CHECK(*decoded == golden.message);
  }
}

}  // namespace runstone::test
