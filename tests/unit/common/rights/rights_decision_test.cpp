#include <catch2/catch.hpp>

#include "common/rights/rights_state.hpp"
#include "tests/support/rights/random_rights.hpp"

namespace runstone::test {
namespace {

using Reason = RightsDecision::Reason;
const PublicKey kOwner = key_of(11), kGuest = key_of(12);

ProtectedBox owned_box(const std::string& name, const VoxelBox& box, std::int32_t priority = 0) {
  ProtectedBox out;
  out.name = name;
  out.box = box;
  out.owner = kOwner;
  out.priority = priority;
  return out;
}

RightsDecision decide_box(const RightsState& state, const PublicKey& key, const VoxelBox& edit) {
  return state.decide_edit(
      key, edit, [&](const VoxelBox& part) { return !intersect(part, edit).empty(); }, 0);
}

constexpr VoxelBox kHouse = {{0, 0, 0}, {10, 10, 10}};

}  // namespace

TEST_CASE("a box admits its owner, members, roles and build_protected", "[rights]") {
  RightsState state;
  ProtectedBox house = owned_box("house", kHouse);
  state.apply(Protect{house}, {1, 0, 0});
  const VoxelBox edit = {{3, 3, 3}, {4, 4, 4}};
  const RightsDecision own = decide_box(state, kOwner, edit);
  CHECK(own.is_allowed);
  CHECK(own.reason == Reason::box);
  CHECK(own.box == &state.find_box("house")->value);
  const RightsDecision others = decide_box(state, kGuest, edit);
  CHECK_FALSE(others.is_allowed);
  CHECK(others.reason == Reason::box);
  CHECK(others.by.seq == 1);
  CHECK(others.box->name == "house");

  house.members = {kGuest};
  state.apply(Protect{house}, {2, 0, 0});
  CHECK(decide_box(state, kGuest, edit).is_allowed);
  house.members.clear();
  house.roles = {kBuilderRole};
  state.apply(Protect{house}, {3, 0, 0});
  CHECK(decide_box(state, kGuest, edit).is_allowed);
  house.roles.clear();
  state.apply(Protect{house}, {4, 0, 0});
  CHECK_FALSE(decide_box(state, kGuest, edit).is_allowed);
  state.apply(GrantRole{kGuest, kModeratorRole}, {5, 0, 0});
  CHECK(decide_box(state, kGuest, edit).is_allowed);
  state.apply(Restrict{RestrictionKind::freeze, kGuest, 0, ""}, {6, 0, 0});
  CHECK(decide_box(state, kGuest, edit).reason == Reason::freeze);
}

TEST_CASE("an edit that only comes near a box is not rejected by it", "[rights]") {
  RightsState state;
  state.apply(Protect{owned_box("house", kHouse)}, {1, 0, 0});
  // Two voxels at opposite corners of their bounding box, which holds the house.
  const VoxelPos a = {-1, -1, -1}, b = {10, 10, 10};
  const auto touches = [&](const VoxelBox& part) { return part.contains(a) || part.contains(b); };
  const RightsDecision decision =
      state.decide_edit(kGuest, {a, {b.x + 1, b.y + 1, b.z + 1}}, touches, 0);
  CHECK(decision.is_allowed);
  CHECK(decision.reason == Reason::default_role);
  CHECK(decision.box == nullptr);
}

TEST_CASE("a single voxel of a box of somebody else rejects the whole edit", "[rights]") {
  RightsState state;
  state.apply(Protect{owned_box("house", kHouse)}, {1, 0, 0});
  CHECK_FALSE(decide_box(state, kGuest, {{9, 9, 9}, {40, 40, 40}}).is_allowed);
  CHECK(decide_box(state, kGuest, {{10, 9, 9}, {40, 40, 40}}).is_allowed);
}

TEST_CASE("a box of higher priority opens a part of a larger one", "[rights]") {
  RightsState state;
  state.apply(Protect{owned_box("house", kHouse, 3)}, {1, 0, 0});
  ProtectedBox door = owned_box("door", {{2, 2, 2}, {5, 5, 5}}, 4);
  door.roles = {kBuilderRole};
  state.apply(Protect{door}, {2, 0, 0});
  CHECK(decide_box(state, kGuest, {{2, 2, 2}, {5, 5, 5}}).is_allowed);
  CHECK_FALSE(decide_box(state, kGuest, {{2, 2, 2}, {5, 5, 6}}).is_allowed);
  door.priority = 2;
  state.apply(Protect{door}, {3, 0, 0});
  CHECK_FALSE(decide_box(state, kGuest, {{2, 2, 2}, {5, 5, 5}}).is_allowed);
}

TEST_CASE("a member without the right to build builds in the box and not beside it", "[rights]") {
  RightsState state;
  state.apply(SetDefaultRole{kVisitorRole}, {1, 4, 5});
  ProtectedBox house = owned_box("house", kHouse);
  house.members = {kGuest};
  state.apply(Protect{house}, {2, 0, 0});
  CHECK(decide_box(state, kGuest, kHouse).is_allowed);
  const RightsDecision beside = decide_box(state, kGuest, {{9, 9, 9}, {11, 10, 10}});
  CHECK_FALSE(beside.is_allowed);
  CHECK(beside.reason == Reason::default_role);
  CHECK(beside.by == ChangeOrigin{1, 4, 5});
  CHECK_FALSE(decide_box(state, kGuest, {{20, 0, 0}, {21, 1, 1}}).is_allowed);
  // Two boxes side by side are one ground.
  house.name = "annex";
  house.box = {{10, 0, 0}, {20, 10, 10}};
  state.apply(Protect{house}, {3, 0, 0});
  CHECK(decide_box(state, kGuest, {{9, 9, 9}, {11, 10, 10}}).is_allowed);
}

TEST_CASE("an edit that would need too many parts is rejected", "[rights]") {
  RightsState state;
  const VoxelBox plain = {{0, 0, 0}, {400, 1, 400}};
  state.apply(Protect{owned_box("plain", plain)}, {1, 0, 0});
  Sequence seq = 1;
  // A grid of open voxels leaves more than kEditBoxPartsMax parts of the plain.
  for (std::int32_t x = 1; x < 400; x += 4) {
    for (std::int32_t z = 1; z < 400; z += 8) {
      ProtectedBox hole = owned_box("hole-" + std::to_string(x) + "-" + std::to_string(z),
                                    {{x, 0, z}, {x + 1, 1, z + 1}}, 1);
      hole.members = {kGuest};
      state.apply(Protect{hole}, {++seq, 0, 0});
    }
  }
  const VoxelPos hole = {1, 0, 1};
  const auto touches = [&](const VoxelBox& part) { return part.contains(hole); };
  CHECK(state.decide_edit(kGuest, {hole, {2, 1, 2}}, touches, 0).is_allowed);
  const RightsDecision decision = state.decide_edit(kGuest, plain, touches, 0);
  CHECK_FALSE(decision.is_allowed);
  CHECK(decision.box->name == "plain");
}

}  // namespace runstone::test
