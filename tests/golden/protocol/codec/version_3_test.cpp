#include <catch2/catch.hpp>

#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/limits.hpp"
#include "tests/support/core/hex.hpp"

// The additions of version 3 of the protocol. They may change until version 3 is released.
namespace runstone::test {

TEST_CASE("the features of version 3 have their numbers", "[protocol][golden]") {
  CHECK(kFeatureTimeCorrections == 1 << 14);
  CHECK(kFeatureLargeActions == 1 << 15);
  CHECK(kFeatureLibrary == 1 << 16);
  CHECK(kFeatureBuilds == 1 << 17);
}

TEST_CASE("the kinds of version 3 have their numbers", "[protocol][golden]") {
  CHECK(wire_number(kKindOf<BuildsRequest>) == 52);
  CHECK(wire_number(kKindOf<Builds>) == 53);
  CHECK(wire_number(kKindOf<BuildPieceRequest>) == 54);
  CHECK(wire_number(kKindOf<BuildPiece>) == 55);
  CHECK(wire_number(kKindOf<BuildOffer>) == 56);
  CHECK(wire_number(kKindOf<BuildUpload>) == 57);
  CHECK(wire_number(kKindOf<BuildAnswer>) == 58);
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

}  // namespace runstone::test
