#include "common/rights/ground_decision.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "common/rights/box_index.hpp"
#include "common/rights/rights_state.hpp"
#include "tests/support/rights/random_rights.hpp"

namespace runstone::test {
namespace {

constexpr VoxelBox kWhole = {{0, 0, 0}, {10, 10, 10}}, kHalf = {{0, 0, 0}, {5, 10, 10}},
                   kOtherHalf = {{5, 0, 0}, {10, 10, 10}};

/// Decides about an edit that fills `edit`.
GroundDecision decide_fill(const std::vector<GroundRule>& rules, const VoxelBox& edit,
                           bool may_build) {
  return decide_ground(rules, edit, may_build,
                       [&](const VoxelBox& box) { return overlaps(box, edit); });
}

}  // namespace

TEST_CASE("the priority orders boxes, then the newer record", "[rights]") {
  CHECK(decides_before({1, 1, "a"}, {0, 2, "b"}));
  CHECK_FALSE(decides_before({0, 2, "b"}, {1, 1, "a"}));
  CHECK(decides_before({0, 2, "b"}, {0, 1, "a"}));
  CHECK(decides_before({0, 1, "a"}, {0, 1, "b"}));
  CHECK_FALSE(decides_before({0, 1, "a"}, {0, 1, "a"}));
}

TEST_CASE("without a rule the free ground decides", "[rights]") {
  CHECK(decide_fill({}, kWhole, true).is_allowed);
  CHECK_FALSE(decide_fill({}, kWhole, false).is_allowed);
  CHECK_FALSE(decide_fill({}, kWhole, true).rule.has_value());
}

TEST_CASE("a rule in front hides the ground behind it, and only that", "[rights]") {
  const std::vector<GroundRule> opened = {{kHalf, true}, {kWhole, false}};
  CHECK(decide_fill(opened, kHalf, true).is_allowed);
  CHECK(decide_fill(opened, kHalf, true).rule == 0U);
  CHECK_FALSE(decide_fill(opened, kWhole, true).is_allowed);
  CHECK(decide_fill(opened, kWhole, true).rule == 1U);
  const std::vector<GroundRule> whole = {{kHalf, true}, {kOtherHalf, true}, {kWhole, false}};
  CHECK(decide_fill(whole, kWhole, false).is_allowed);
  const VoxelBox larger = {{0, 0, 0}, {11, 10, 10}};
  CHECK_FALSE(decide_fill({{kWhole, true}}, larger, false).is_allowed);
  CHECK_FALSE(decide_fill({{kWhole, true}}, larger, false).rule.has_value());
}

TEST_CASE("the rights in force are those that are allowed one by one", "[rights]") {
  SplitMix64 rng{Catch::rngSeed()};
  RightsState state;
  for (Sequence seq = 1; seq <= 300; ++seq) {
    state.apply(random_close_change(rng), {seq, 1, 0});
    const PublicKey key = key_of(static_cast<std::uint8_t>(rng.below(kCloseKeys)));
    RightSet one_by_one;
    for (std::uint8_t right = 0; right < kRightCount; ++right) {
      if (state.decide(key, Right{right}, 50).is_allowed) one_by_one.add(Right{right});
    }
    const std::uint32_t known = RightSet::all().bits();
    CHECK((state.rights_in_force(key, 50).bits() & known) == one_by_one.bits());
  }
}

TEST_CASE("some of the boxes are as many as asked for, or all", "[rights]") {
  RightsState state;
  for (Sequence seq = 1; seq <= 50; ++seq)
    state.apply(Protect{{"b" + std::to_string(seq), kHalf, 0, {}, {}, {}}}, {seq, 1, 0});
  state.apply(Protect{{"far", {{50, 0, 0}, {51, 1, 1}}, 0, {}, {}, {}}}, {51, 1, 0});
  CHECK(state.some_boxes_in(kWhole, 10).size() == 10);
  CHECK(state.some_boxes_in(kWhole, 100).size() == 50);
  CHECK(state.some_boxes_in(kOtherHalf, 100).empty());
}

}  // namespace runstone::test
