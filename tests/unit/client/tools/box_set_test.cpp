#include "client/tools/box_set.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "client/tools/tool_command.hpp"
#include "common/core/hash.hpp"
#include "common/materials/material_table.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

using VoxelSet = std::set<VoxelPos>;

VoxelSet voxels_in(const BoxSet& set) {
  VoxelSet out;
  for (const VoxelBox& box : set.boxes()) {
    CHECK_FALSE(box.empty());
    for (VoxelPos v = box.min; v.z < box.max.z; ++v.z) {
      for (v.y = box.min.y; v.y < box.max.y; ++v.y) {
        for (v.x = box.min.x; v.x < box.max.x; ++v.x) {
          if (!out.insert(v).second) FAIL_CHECK("two boxes overlap");
        }
      }
    }
  }
  return out;
}

VoxelBox random_box(SplitMix64& rng) {
  const auto at = [&] {
    return VoxelPos{rng.between(-6, 5), rng.between(-6, 5), rng.between(-6, 5)};
  };
  return box_between(at(), at());
}

/// Returns the voxels moved by some steps.
VoxelSet moved_voxels(const VoxelSet& from, Direction direction, std::int32_t steps) {
  VoxelSet out;
  for (const VoxelPos v : from) out.insert(moved(v, direction, steps));
  return out;
}

}  // namespace

TEST_CASE("sets of boxes are what sets of voxels are", "[tools][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int round = 0; round < 40; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    BoxSet set(random_box(rng));
    VoxelSet wanted = voxels_in(set);
    for (int step = 0; step < 6; ++step) {
      const BoxSet box(random_box(rng));
      const VoxelSet other = voxels_in(box);
      VoxelSet now;
      std::optional<BoxSet> made;
      if (const std::uint32_t kind = rng.below(4); kind <= 1) {
        made = BoxSet::united(set, box);
        now = wanted;
        now.insert(other.begin(), other.end());
      } else if (kind == 2) {
        made = BoxSet::without(set, box);
        std::set_difference(wanted.begin(), wanted.end(), other.begin(), other.end(),
                            std::inserter(now, now.end()));
      } else {
        BoxSet both = box;
        if (auto more = BoxSet::united(box, BoxSet(random_box(rng)))) both = *more;
        const VoxelSet all = voxels_in(both);
        made = BoxSet::common(set, both);
        std::set_intersection(wanted.begin(), wanted.end(), all.begin(), all.end(),
                              std::inserter(now, now.end()));
      }
      REQUIRE(made);
      set = *std::move(made);
      wanted = std::move(now);
      REQUIRE(voxels_in(set) == wanted);
      REQUIRE(set.empty() == wanted.empty());
    }
    const auto direction = static_cast<Direction>(rng.below(kDirectionCount));
    const std::int32_t steps = rng.between(0, 5);
    CHECK(voxels_in(set.moved(direction, steps)) == moved_voxels(wanted, direction, steps));
    VoxelSet more = wanted, less = wanted;
    for (std::int32_t i = 1; i <= steps; ++i) {
      const VoxelSet ahead = moved_voxels(wanted, direction, i),
                     behind = moved_voxels(wanted, direction, -i);
      more.insert(ahead.begin(), ahead.end());
      std::erase_if(less, [&](VoxelPos v) { return !behind.contains(v); });
    }
    CHECK(voxels_in(set.grown(direction, steps).value()) == more);
    CHECK(voxels_in(set.shrunk(direction, steps).value()) == less);
    for (int i = 0; i < 20; ++i) {
      const VoxelPos v{rng.between(-7, 7), rng.between(-7, 7), rng.between(-7, 7)};
      CHECK(set.contains(v) == wanted.contains(v));
    }
  }
}

TEST_CASE("boxes that together are a box are one", "[tools]") {
  const VoxelBox box{{0, 0, 0}, {9, 9, 9}};
  const auto holed = BoxSet::without(BoxSet(box), BoxSet({{3, 3, 3}, {6, 6, 6}}));
  REQUIRE(holed);
  CHECK(holed->boxes().size() == 6);
  CHECK(holed->around() == box);
  const auto whole = BoxSet::united(*holed, BoxSet({{3, 3, 3}, {6, 6, 6}}));
  REQUIRE(whole);
  REQUIRE(whole->boxes().size() == 1);
  CHECK(whole->boxes().front() == box);
}

TEST_CASE("a set of more than 256 boxes is refused", "[tools]") {
  std::optional<BoxSet> set = BoxSet();
  std::int32_t count = 0;
  while (true) {
    auto next = BoxSet::united(*set, BoxSet({{2 * count, 0, 0}, {2 * count + 1, 1, 1}}));
    if (!next) break;
    set = std::move(next);
    ++count;
  }
  CHECK(count == 256);
}

TEST_CASE("the commands of a selection of several boxes change exactly its voxels",
          "[tools][property]") {
  SplitMix64 rng{Catch::rngSeed() + 1};
  for (int round = 0; round < 24; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    ToolBench bench;
    bench.rng = SplitMix64(rng.next());
    bench.show_random();
    ToolBox& box = bench.box;
    box.set_materials(default_material_table());
    REQUIRE(box.select(random_box(rng), SelectMode::fresh));
    for (int i = 0; i < 3; ++i)
      REQUIRE(
          box.select(random_box(rng), rng.below(3) == 0 ? SelectMode::remove : SelectMode::add));
    const VoxelSet selected = voxels_in(box.selected_boxes());
    if (selected.empty()) {
      CHECK(box.fill(bench.replica, 2).error() == "nothing is selected");
      continue;
    }
    constexpr std::int32_t kReach = 14;
    std::map<VoxelPos, Material> wanted;
    for (VoxelPos v{-kReach, -kReach, -kReach}; v.z < kReach; ++v.z) {
      for (v.y = -kReach; v.y < kReach; ++v.y) {
        for (v.x = -kReach; v.x < kReach; ++v.x) wanted[v] = bench.at(v);
      }
    }
    const std::map<VoxelPos, Material> before = wanted;
    ToolEdits made = failure(std::string());
    const auto direction = static_cast<Direction>(rng.below(kDirectionCount));
    const std::int32_t steps = rng.between(1, 5);
    switch (round % 4) {
      case 0:
        made = box.fill(bench.replica, 3);
        for (const VoxelPos v : selected) wanted[v] = 3;
        break;
      case 1:
        made = box.replace(bench.replica, 1, 2);
        for (const VoxelPos v : selected) {
          if (wanted[v] == 1) wanted[v] = 2;
        }
        break;
      case 2: {
        const bool is_solid = rng.below(2) == 0;
        made = box.cut(bench.replica, is_solid);
        for (const VoxelPos v : selected) wanted[v] = kEmpty;
        if (!made) break;
        // The copy has exactly the cells of the selection.
        const VoxelBox around = *box.selection();
        std::size_t wrong = 0;
        for (const auto& [v, material] : before) {
          if (!around.contains(v)) continue;
          const auto cell = box.clipboard().build->at(
              {v.x - around.min.x, v.y - around.min.y, v.z - around.min.z});
          if (cell != (selected.contains(v) ? std::optional(material) : std::nullopt)) ++wrong;
        }
        CHECK(wrong == 0);
        CHECK(box.clipboard().empty == (is_solid ? EmptyCells::skipped : EmptyCells::pasted));
        break;
      }
      default:
        made = box.move(bench.replica, direction, steps);
        for (const VoxelPos v : selected) {
          if (!selected.contains(moved(v, direction, -steps))) wanted[v] = kEmpty;
        }
        for (const VoxelPos v : selected) {
          const VoxelPos to = moved(v, direction, steps);
          if (before.at(v) != kEmpty || selected.contains(to)) wanted[to] = before.at(v);
        }
        break;
    }
    if (!made) {
      CHECK(made.error() == "the selection is empty");
      continue;
    }
    bench.predict(*made);
    std::size_t wrong = 0;
    for (const auto& [v, material] : wanted) wrong += bench.at(v) != material ? 1 : 0;
    CHECK(wrong == 0);
  }
}

TEST_CASE("a held key adds a chosen box to the selection or removes it", "[tools]") {
  ToolBench bench;
  bench.show_flat();
  ToolBox& box = bench.box;
  REQUIRE(box.choose("select"));
  const auto choose = [&](VoxelPos a, VoxelPos b) {
    for (const VoxelPos at : {a, b})
      REQUIRE(box.press(bench.replica, bench.aim_at(at, Direction::pos_y), ToolButton::place));
  };
  choose({0, -1, 0}, {3, -1, 0});
  box.hold_select_mode(SelectMode::add);
  choose({8, -1, 0}, {9, -1, 0});
  CHECK(voxels_in(box.selected_boxes()).size() == 6);
  CHECK_FALSE(box.selected_box());
  box.hold_select_mode(SelectMode::remove);
  choose({2, -1, 0}, {8, -1, 0});
  CHECK(voxels_in(box.selected_boxes()) == VoxelSet{{0, -1, 0}, {1, -1, 0}, {9, -1, 0}});
  box.hold_select_mode(std::nullopt);
  REQUIRE(box.set_parameter("mode", 1));
  choose({5, -1, 0}, {5, -1, 0});
  CHECK(voxels_in(box.selected_boxes()).size() == 4);
  SelectionCommand grow;
  grow.kind = SelectionCommand::Kind::grow;
  grow.is_all_around = true;
  REQUIRE(carry_out(box, bench.replica, 2, grow));
  CHECK(box.selection() == VoxelBox{{-1, -2, -1}, {11, 1, 2}});
  grow.count = -1;
  REQUIRE(carry_out(box, bench.replica, 2, grow));
  CHECK(box.selected_boxes().contains({9, -1, 0}));
  CHECK_FALSE(box.selected_boxes().contains({10, -1, 0}));
  const BoxSet before = box.selected_boxes();
  grow.count = -9;
  CHECK(carry_out(box, bench.replica, 2, grow).error() == "nothing would be left of the selection");
  CHECK(box.selection() == before.around());
  REQUIRE(box.set_parameter("mode", 0));
  choose({0, -1, 0}, {0, -1, 0});
  CHECK(box.selected_box() == VoxelBox{{0, -1, 0}, {1, 0, 1}});
}

TEST_CASE("a set of as many boxes as may be grows", "[tools]") {
  std::optional<BoxSet> set = BoxSet();
  for (std::int32_t i = 0; i < 256; ++i)
    set = BoxSet::united(*set, BoxSet({{2 * i, 0, 0}, {2 * i + 1, 1, 1}})).value();
  const BoxSet deep = set->grown(Direction::neg_z, 3).value();
  CHECK(deep.boxes().size() == 256);
  CHECK(deep.around() == VoxelBox{{0, 0, -3}, {511, 1, 1}});
  CHECK(deep.contains({510, 0, -3}));
  CHECK_FALSE(deep.contains({509, 0, -3}));
  const BoxSet whole = set->grown(Direction::pos_x, 9).value();
  REQUIRE(whole.boxes().size() == 1);
  CHECK(whole.boxes().front() == VoxelBox{{0, 0, 0}, {520, 1, 1}});
}

TEST_CASE("a copy of several boxes is bounded along all axes", "[tools]") {
  ToolBench bench;
  bench.show_flat();
  ToolBox& box = bench.box;
  const auto copied = [&](const VoxelBox& second) {
    box.select(VoxelBox{{0, 0, 0}, {1, 1, 1}});
    REQUIRE(box.select(second, SelectMode::add));
    REQUIRE(box.selected_boxes().boxes().size() == 2);
    return box.copy(bench.replica, false);
  };
  const std::string words =
      "too many voxels to copy of several boxes: select one box, or fewer voxels";
  constexpr std::int32_t kFar = kWorldLimit;
  // Long rows, many rows, and as many of both as there are.
  CHECK(copied({{-kFar, 2, 0}, {kFar, 3, 1}}).error() == words);
  CHECK(copied({{0, 2, 0}, {1, 1026, 1025}}).error() == words);
  CHECK(copied({{-kFar, 2, -kFar}, {kFar, kFar, kFar}}).error() == words);
  CHECK(copied({{-32, 2, -32}, {32, 30, 32}}));
  const Replica closed;
  CHECK(box.copy(closed, false).error() == "no world is open");
}

TEST_CASE("replace and wand work in all boxes of a selection, and so does a mix", "[tools]") {
  ToolBench bench;
  bench.show_flat();
  ToolBox& box = bench.box;
  box.set_materials(default_material_table());
  REQUIRE(box.select({{0, -1, 0}, {2, 0, 1}}, SelectMode::fresh));
  REQUIRE(box.select({{4, -1, 0}, {6, 0, 1}}, SelectMode::add));
  const auto click = [&](const char* tool, const char* parameter, std::int32_t value) {
    REQUIRE(box.choose(tool));
    REQUIRE(box.set_parameter(parameter, value));
    auto made =
        box.press(bench.replica, bench.aim_at({0, -1, 0}, Direction::pos_y), ToolButton::place);
    REQUIRE(made);
    return *std::move(made);
  };
  const auto row = [&](Material selected) {
    for (std::int32_t x = -1; x < 8; ++x) {
      const bool is_in = x == 0 || x == 1 || x == 4 || x == 5;
      CHECK(bench.at({x, -1, 0}) == (is_in ? selected : Material{1}));
    }
  };
  click("wand", "reach", 1);
  CHECK(box.clipboard().build->touched() == 4);
  bench.predict(click("replace", "where", 2));
  row(2);
  REQUIRE(box.choose("mix"));
  REQUIRE(box.set_text("pattern", "glass"));
  const ToolAction mixed = click("mix", "region", 1);
  REQUIRE(mixed.pattern);
  const auto source = source_of(mixed, bench.replica.edit_limits());
  for (SourceStep step = source->next(); step.kind != SourceStep::Kind::end;
       step = source->next()) {
    REQUIRE(step.kind == SourceStep::Kind::edit);
    bench.predict({step.edit});
  }
  row(*default_material_table().find("glass"));
}

}  // namespace runstone::test
