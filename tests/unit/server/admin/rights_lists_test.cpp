#include "server/admin/rights_lists.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/rights_reason.hpp"

namespace runstone::rights_lists_test {
namespace {

constexpr TimeUs kDay = 86'400'000'000;
constexpr TimeUs kNow = 1'000'000'000'000'000;  // 2001-09-09T01:46:40Z
const PublicKey kAna{1}, kMole{2}, kBoss{3};

KnownPlayers known() {
  KnownPlayers::Sources sources;
  sources.stored = {{1, kAna, "ana"}, {2, kMole, "the mole"}, {3, kBoss, "boss"}};
  return KnownPlayers(sources);
}
std::string named(const std::string& name, const PublicKey& key) {
  return name + " " + key_fingerprint(key);
}
/// Returns the text of a record that the boss made.
std::string record(Sequence seq) {
  return "record " + std::to_string(seq) + ", 2001-09-09T01:46:40Z, by " + named("boss #3", kBoss);
}
std::string why(const RightsState& state, const RightsQuestion& question) {
  return rights_reason(state, question, kNow, known());
}

}  // namespace

TEST_CASE("roles lists rights, limits, grants and records", "[admin][rights]") {
  RightsState state;
  state.apply(DefineRole{{"mason", {Right::see}, 1000, 0, 0}}, {5, 3, kNow});
  state.apply(SetDefaultRole{"mason"}, {6, 3, kNow});
  state.apply(GrantRole{kAna, "visitor"}, {7, 3, kNow});
  const std::string text = role_list(state, known());
  CHECK(text.find("mason (default): see volume 1000; 0 grants; " + record(5) + "\n") !=
        std::string::npos);
  CHECK(text.find("visitor: see,look_back,chat; 1 grant; built in") != std::string::npos);
}

TEST_CASE("grants lists player, role, time and giver", "[admin][rights]") {
  RightsState state;
  CHECK(grant_list(state, 0, known()) ==
        "nobody has a granted role (roles names the default role)");
  state.apply(GrantRole{kAna, "moderator"}, {7, 3, kNow});
  CHECK(grant_list(state, 0, known()) == named("ana #1", kAna) + ": moderator; " + record(7));
}

TEST_CASE("bans lists what is in force", "[admin][rights]") {
  RightsState state;
  CHECK(restriction_list(state, kNow, known()) == "nobody is banned, muted or frozen");
  state.apply(Restrict{RestrictionKind::ban, kAna, kNow + kDay, "grief"}, {7, 3, kNow});
  state.apply(Restrict{RestrictionKind::mute, kMole, kNow, "over"}, {8, 3, kNow});
  const AddressRange range{address_block_v4(0xc0'00'02'00), 32 + 24};
  state.apply(Restrict{RestrictionKind::ban, range, 0, ""}, {9, 0, kNow});
  CHECK(restriction_list(state, kNow, known()) ==
        named("ana #1", kAna) + ": banned until 2001-09-10T01:46:40Z, \"grief\"; " + record(7) +
            "\n192.0.2.0/24: banned until it is lifted; record 9, 2001-09-09T01:46:40Z, by the "
            "server");
}

TEST_CASE("protected lists the boxes, at most 500", "[admin][rights]") {
  RightsState state;
  CHECK(box_list({}, known()) == "no ground is protected");
  state.apply(Protect{{"town", {{1, 2, 3}, {5, 6, 7}}, 4, kAna, {kMole}, {"visitor"}}},
              {7, 3, kNow});
  const auto* town = state.find_box("town");
  CHECK(box_list({town}, known()) ==
        "town: 1 2 3 to 4 5 6, priority 4, owner " + named("ana #1", kAna) + ", members " +
            named("the mole #2", kMole) + ", roles visitor; " + record(7));
  CHECK(box_list(std::vector<const Decided<ProtectedBox>*>(502, town), known())
            .ends_with("\nand 2 more"));
}

TEST_CASE("why names the role that decides, and its record", "[admin][rights]") {
  RightsState state;
  state.apply(SetDefaultRole{kBuilderRole}, {4, 3, kNow});
  CHECK(why(state, {kAna, Right::build, {}}) ==
        "yes: " + named("ana #1", kAna) +
            " has the right build\nthe player has no grant, and the default role is builder (" +
            record(4) + ")");
  state.apply(GrantRole{kAna, kVisitorRole}, {7, 3, kNow});
  CHECK(why(state, {kAna, Right::build, {}}) ==
        "no: " + named("ana #1", kAna) +
            " does not have the right build\nthe player was given the role visitor (" + record(7) +
            ")");
  state.apply(DefineRole{{kVisitorRole, {Right::see, Right::build}, 0, 0, 0}}, {8, 3, kNow});
  CHECK(why(state, {kAna, Right::build, {}}) ==
        "yes: " + named("ana #1", kAna) + " has the right build\nthe role visitor is see,build (" +
            record(8) + ")");
}

TEST_CASE("why names the restriction with its reason", "[admin][rights]") {
  RightsState state;
  state.apply(Restrict{RestrictionKind::freeze, kAna, kNow + kDay, "grief"}, {7, 3, kNow});
  CHECK(why(state, {kAna, Right::build, VoxelPos{1, 2, 3}}) ==
        "no: " + named("ana #1", kAna) +
            " may not change the voxel 1 2 3\n"
            "the player is frozen until 2001-09-10T01:46:40Z: grief (" +
            record(7) + ")");
}

TEST_CASE("why names the box that decides", "[admin][rights]") {
  RightsState state;
  state.apply(SetDefaultRole{kBuilderRole}, {4, 3, kNow});
  state.apply(Protect{{"town", {{0, 0, 0}, {9, 9, 9}}, 0, kMole, {}, {}}}, {7, 3, kNow});
  CHECK(why(state, {kAna, Right::build, VoxelPos{1, 2, 3}}) ==
        "no: " + named("ana #1", kAna) +
            " may not change the voxel 1 2 3\n"
            "the ground is protected: town 0 0 0 to 8 8 8 owner " +
            key_fingerprint(kMole) + " (" + record(7) + ")");
  CHECK(why(state, {kMole, Right::build, VoxelPos{1, 2, 3}}).starts_with("yes: "));
  CHECK(why(state, {kAna, Right::build, VoxelPos{1, 2, 9}}).starts_with("yes: "));
}

}  // namespace runstone::rights_lists_test
