// A client that has all boxes decides about edits as the server does.
#include "client/replica/known_ground.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/rights/rights_state.hpp"
#include "protocol/rules/refusal_text.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/rights/random_rights.hpp"

namespace runstone::test {
namespace {

/// Returns what a server would send the player of this state.
KnownGround ground_of_player(const RightsState& state, const PublicKey& key, TimeUs now_us) {
  const Role& role = state.role_of(key);
  KnownGround ground;
  const bool may_edit = state.restriction(RestrictionKind::ban, key, now_us) == nullptr &&
                        state.restriction(RestrictionKind::freeze, key, now_us) == nullptr;
  ground.receive({role.name, state.rights_in_force(key, now_us).bits(), role.edit_volume_max,
                  may_edit ? "" : "you may not edit"});
  ProtectedGround change;
  for (const auto& [name, box] : state.boxes()) {
    change.boxes.push_back(
        {box.by.seq, box.value.box, box.value.priority, admits(box.value, key, role), name, ""});
  }
  REQUIRE(ground.receive(change).has_value());
  return ground;
}

EditDescriptor random_close_edit(SplitMix64& rng) {
  const VoxelBox place = random_box_in(rng, {{-9, -9, -9}, {9, 9, 9}}, 7);
  EditDescriptor edit;
  switch (rng.below(4)) {
    case 0:
      edit.shape = SetVoxel{place.min};
      break;
    case 1:
      edit.shape = FillBox{place};
      break;
    case 2:
      edit.shape = FillSphere{place.min, static_cast<std::uint16_t>(rng.below(4))};
      break;
    default:
      edit.shape = random_stroke(rng, place.min);
  }
  edit.material = 1;
  return edit;
}

}  // namespace

TEST_CASE("a client that knows all boxes refuses exactly the edits that the server rejects",
          "[replica][rights][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  constexpr TimeUs kTimeUs = 50;
  int allowed = 0, by_box = 0, by_other = 0;
  for (int world = 0; world < 100; ++world) {
    RightsState state;
    for (Sequence seq = 1; seq <= 60; ++seq) state.apply(random_close_change(rng), {seq, 1, 0});
    for (std::uint8_t who = 0; who < kCloseKeys; ++who) {
      const KnownGround ground = ground_of_player(state, key_of(who), kTimeUs);
      const std::uint64_t volume_max = state.role_of(key_of(who)).edit_volume_max;
      for (int i = 0; i < 40; ++i) {
        const EditDescriptor edit = random_close_edit(rng);
        CAPTURE(Catch::rngSeed(), world, int{who}, i, edit);
        const RightsDecision decision = state.decide_edit(
            key_of(who), bounding_box(edit),
            [&edit](const VoxelBox& box) { return touches(edit, box); }, kTimeUs);
        const bool is_small = volume_max == 0 || counted_voxels(edit) <= volume_max;
        const auto refusal = ground.refusal(edit);
        REQUIRE(refusal.has_value() == !(decision.is_allowed && is_small));
        if (!refusal) {
          ++allowed;
        } else if (decision.reason == RightsDecision::Reason::box && is_small) {
          ++by_box;
          CHECK(*refusal == refused_by_box(decision.box->name));
        } else {
          ++by_other;
        }
      }
    }
  }
  CHECK(std::min({allowed, by_box, by_other}) > 1000);
}

}  // namespace runstone::test
