// An edit is decided as if each of its voxels were looked up on its own.
#include <algorithm>
#include <catch2/catch.hpp>

#include "common/rights/rights_state.hpp"
#include "tests/support/rights/random_rights.hpp"

namespace runstone::test {
namespace {

/// The voxels of an edit as a list, so that the oracle knows no shapes.
struct ListedEdit {
  std::vector<VoxelPos> voxels;
  VoxelBox bounds;

  bool touches(const VoxelBox& box) const {
    for (const VoxelPos& p : voxels) {
      if (box.contains(p)) return true;
    }
    return false;
  }
};

template <class F>
ListedEdit listed_edit(const VoxelBox& around, F&& is_inside) {
  ListedEdit edit{{}, {{1000, 1000, 1000}, {-1000, -1000, -1000}}};
  for (std::int32_t x = around.min.x; x < around.max.x; ++x) {
    for (std::int32_t y = around.min.y; y < around.max.y; ++y) {
      for (std::int32_t z = around.min.z; z < around.max.z; ++z) {
        const VoxelPos p = {x, y, z};
        if (!is_inside(p)) continue;
        edit.voxels.push_back(p);
        VoxelBox& b = edit.bounds;
        b.min = {std::min(b.min.x, x), std::min(b.min.y, y), std::min(b.min.z, z)};
        b.max = {std::max(b.max.x, x + 1), std::max(b.max.y, y + 1), std::max(b.max.z, z + 1)};
      }
    }
  }
  return edit;
}

/// A voxel, a box, a sphere, or a diagonal line, whose bounding box is mostly empty.
ListedEdit random_listed_edit(SplitMix64& rng) {
  const VoxelBox place = random_box_in(rng, {{-9, -9, -9}, {9, 9, 9}}, 7);
  const VoxelPos c = place.min;
  switch (rng.below(4)) {
    case 0:
      return {{c}, {c, {c.x + 1, c.y + 1, c.z + 1}}};
    case 1:
      return listed_edit(place, [](VoxelPos) { return true; });
    case 2: {
      const std::int32_t r = rng.between(0, 3);
      return listed_edit({{c.x - r, c.y - r, c.z - r}, {c.x + r + 1, c.y + r + 1, c.z + r + 1}},
                         [&](VoxelPos p) {
                           const std::int32_t x = p.x - c.x, y = p.y - c.y, z = p.z - c.z;
                           return x * x + y * y + z * z <= r * r + r;
                         });
    }
    default:
      return listed_edit({c, {c.x + 6, c.y + 6, c.z + 6}}, [&](VoxelPos p) {
        return p.x - c.x == p.y - c.y && p.x - c.x == p.z - c.z;
      });
  }
}

/// Looks every voxel up among all boxes.
class DenseRights {
 public:
  struct Made {
    ProtectedBox box;
    Sequence seq;
  };
  std::vector<Made> boxes;
  Role role;
  PublicKey key{};

  const Made* decider_of(VoxelPos p) const {
    const Made* decider = nullptr;
    for (const Made& made : boxes) {
      if (!made.box.box.contains(p)) continue;
      const bool wins = decider == nullptr || made.box.priority > decider->box.priority ||
                        (made.box.priority == decider->box.priority && made.seq > decider->seq);
      if (wins) decider = &made;
    }
    return decider;
  }
  bool allows(VoxelPos p) const {
    const Made* made = decider_of(p);
    if (made == nullptr) return role.rights.has(Right::build);
    if (role.rights.has(Right::build_protected) || made->box.owner == key) return true;
    for (const PublicKey& member : made->box.members) {
      if (member == key) return true;
    }
    for (const std::string& name : made->box.roles) {
      if (name == role.name) return true;
    }
    return false;
  }
};

struct Outcomes {
  int allowed = 0, by_box = 0, by_role = 0, in_box = 0;
};

void check_edit(const RightsState& state, const DenseRights& dense, const ListedEdit& edit,
                Outcomes& outcomes) {
  const auto touches = [&](const VoxelBox& box) {
    REQUIRE_FALSE(box.empty());
    return edit.touches(box);
  };
  const RightsDecision decision = state.decide_edit(dense.key, edit.bounds, touches, 50);
  bool is_allowed = true, names_a_decider = false, frees = false;
  for (const VoxelPos& p : edit.voxels) {
    const bool allows = dense.allows(p);
    is_allowed = is_allowed && allows;
    const auto* decider = dense.decider_of(p);
    // The box of the answer decides for a voxel, and that voxel gives the answer.
    if (decider != nullptr && decision.box != nullptr && decider->box == *decision.box &&
        decider->seq == decision.by.seq && allows == decision.is_allowed) {
      names_a_decider = true;
    }
    if (decider == nullptr && allows == decision.is_allowed) frees = true;
  }
  REQUIRE(decision.is_allowed == is_allowed);
  REQUIRE(decision.role == dense.role.name);
  const bool is_by_box = decision.reason == RightsDecision::Reason::box;
  REQUIRE(is_by_box == (decision.box != nullptr));
  REQUIRE((is_by_box ? names_a_decider : frees));
  outcomes.allowed += is_allowed;
  outcomes.in_box += is_allowed && is_by_box;
  outcomes.by_box += !is_allowed && is_by_box;
  outcomes.by_role += !is_allowed && !is_by_box;
}

}  // namespace

TEST_CASE("an edit is allowed if the player may change each of its voxels", "[rights][property]") {
  SplitMix64 rng{64 + Catch::rngSeed()};
  Outcomes outcomes;
  for (int round = 0; round < 400; ++round) {
    RightsState state;
    DenseRights dense;
    dense.key = key_of(static_cast<std::uint8_t>(rng.below(kCloseKeys)));
    Sequence seq = 0;
    const std::uint32_t box_count = rng.below(12);
    for (std::uint32_t i = 0; i < box_count; ++i) {
      const ProtectedBox box = random_close_box(rng);
      std::erase_if(dense.boxes, [&](const auto& made) { return made.box.name == box.name; });
      dense.boxes.push_back({box, ++seq});
      state.apply(Protect{box}, {seq, 1, 0});
    }
    dense.role = built_in_roles()[rng.below(4) == 0 ? 3 : 1 + rng.below(2)];
    if (rng.below(3) == 0) dense.role.rights.add(Right::build_protected);
    if (rng.below(4) == 0) dense.role.rights.remove(Right::build_protected);
    state.apply(DefineRole{dense.role}, {++seq, 1, 0});
    state.apply(GrantRole{dense.key, dense.role.name}, {++seq, 1, 0});
    for (int i = 0; i < 25; ++i) {
      CAPTURE(Catch::rngSeed(), round, i);
      check_edit(state, dense, random_listed_edit(rng), outcomes);
    }
  }
  CHECK(outcomes.allowed > 1000);
  CHECK(outcomes.in_box > 500);
  CHECK(outcomes.by_box > 1000);
  CHECK(outcomes.by_role > 500);
}

TEST_CASE("whole boxes are decided as their voxels are, with many boxes in a small world",
          "[rights][property]") {
  SplitMix64 rng{65 + Catch::rngSeed()};
  for (int round = 0; round < 20; ++round) {
    RightsState state;
    DenseRights dense;
    dense.key = key_of(1);
    dense.role = built_in_roles()[round % 2 == 0 ? 1 : 2];
    state.apply(GrantRole{dense.key, dense.role.name}, {1, 1, 0});
    for (Sequence seq = 2; seq < 120; ++seq) {
      ProtectedBox box = random_close_box(rng);
      box.name = "box-" + std::to_string(seq);
      // Most boxes admit the player, so that a part of an edit is cut many times.
      if (rng.below(8) != 0) box.owner = dense.key;
      state.apply(Protect{box}, {seq, 1, 0});
      dense.boxes.push_back({box, seq});
    }
    Outcomes outcomes;
    for (int i = 0; i < 40; ++i) {
      CAPTURE(Catch::rngSeed(), round, i);
      check_edit(state, dense, random_listed_edit(rng), outcomes);
    }
  }
}

}  // namespace runstone::test
