#include <catch2/catch.hpp>

#include "client/tools/tool_box.hpp"
#include "common/builds/build_builder.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

constexpr VoxelPos kTop{3, -1, 3};

struct TerrainBench : ToolBench {
  TerrainBench() {
    show_flat();
    box.set_materials(default_material_table());
  }
  ToolEdits click(VoxelPos voxel, ToolButton button = ToolButton::place, Material held = 2) {
    return box.press(replica, aim_at(voxel, Direction::pos_y, held), button);
  }
  /// Draws a stroke between two voxels and predicts it.
  void draw(VoxelPos from, VoxelPos to, ToolButton button = ToolButton::place) {
    REQUIRE(click(from, button));
    const auto edits = box.release(replica, aim_at(to, Direction::pos_y));
    REQUIRE(edits);
    predict(*edits);
  }
};

}  // namespace

TEST_CASE_METHOD(TerrainBench, "the terrain tool raises and lowers ground along a stroke",
                 "[tools]") {
  REQUIRE(box.choose("terrain"));
  REQUIRE(box.set_parameter("radius", 2));
  REQUIRE(box.set_parameter("falloff", 3));
  draw({-5, -1, 3}, {5, -1, 3});
  for (std::int32_t x = -5; x <= 5; ++x) CHECK(at({x, 3, 3}) == 1);
  CHECK(at({0, 4, 3}) == kEmpty);
  CHECK(at({0, 0, 6}) == kEmpty);
  draw({-5, 3, 3}, {5, 3, 3}, ToolButton::clear);
  CHECK(at({0, 0, 3}) == kEmpty);
  CHECK(at({0, -1, 3}) == 1);
}

TEST_CASE_METHOD(TerrainBench, "overlay needs a material in the hand", "[tools]") {
  REQUIRE(box.choose("terrain"));
  REQUIRE(box.set_parameter("mode", 6));
  REQUIRE(click(kTop, ToolButton::place, kEmpty));
  const auto refused = box.release(replica, aim_at(kTop, Direction::pos_y, kEmpty));
  REQUIRE_FALSE(refused);
  CHECK(refused.error() == "hold a material to overlay");
}

TEST_CASE_METHOD(TerrainBench, "scatter puts copies of the clipboard on the ground", "[tools]") {
  REQUIRE(box.choose("scatter"));
  REQUIRE(click(kTop));
  CHECK(box.release(replica, aim_at(kTop, Direction::pos_y)).error() ==
        "copy what to scatter first");
  predict({{FillBox{{{10, 0, 10}, {11, 3, 11}}}, {}, 4}});
  box.select(VoxelBox{{10, 0, 10}, {11, 3, 11}});
  REQUIRE(box.copy(replica, true));
  REQUIRE(box.set_parameter("radius", 12));
  REQUIRE(box.set_parameter("spacing", 3));
  REQUIRE(click(kTop));
  const auto edits = box.release(replica, aim_at(kTop, Direction::pos_y));
  REQUIRE(edits);
  CHECK(edits->edits.size() > 4);
  for (const EditDescriptor& edit : edits->edits) {
    const auto& paste = std::get<Paste>(edit.shape);
    CHECK(paste.at.y == 0);
    CHECK(at({paste.at.x, -1, paste.at.z}) == 1);
  }
  for (std::size_t i = 1; i < edits->edits.size(); ++i) {
    const VoxelPos a = std::get<Paste>(edits->edits[i - 1].shape).at,
                   b = std::get<Paste>(edits->edits[i].shape).at;
    CHECK(std::max(std::abs(a.x - b.x), std::abs(a.z - b.z)) > 3);
  }
}

TEST_CASE_METHOD(TerrainBench, "typed places of a stroke lie within a step of each other",
                 "[tools]") {
  predict({{FillBox{{{10, 0, 10}, {11, 1, 11}}}, {}, 4}});
  box.select(VoxelBox{{10, 0, 10}, {11, 1, 11}});
  REQUIRE(box.copy(replica, true));
  const std::string tool = GENERATE(as<std::string>{}, "terrain", "path", "scatter");
  REQUIRE(box.choose(tool));
  const auto refusal = [&](VoxelPos first) {
    TypedPlaces typed;
    typed.places = {first, kTop};
    box.type_places(typed);
    const auto made = box.apply_typed(replica, 2);
    return made ? std::string() : made.error();
  };
  const std::string too_far = "two places are more than 1024 voxels apart";
  // Points half a voxel apart would fill the memory.
  CHECK(refusal({kTop.x + 100'000'000, kTop.y, kTop.z}) == too_far);
  CHECK(refusal({kTop.x, kTop.y, kTop.z - 1'025}) == too_far);
  CHECK(refusal({kTop.x, kTop.y, kTop.z - 1'024}) != too_far);
  CHECK(refusal({kTop.x - 1, kTop.y, kTop.z - 1}).empty());
}

TEST_CASE_METHOD(TerrainBench, "the solid tool fills the box between two clicks", "[tools]") {
  REQUIRE(box.choose("solid"));
  REQUIRE(box.set_parameter("kind", 1));
  REQUIRE(box.set_parameter("fill", 1));
  REQUIRE(box.set_parameter("height", 5));
  REQUIRE(click({-5, -1, -5}));
  const auto edits = click({5, -1, 5});
  REQUIRE(edits);
  predict(*edits);
  CHECK(at({0, 4, 0}) == 2);
  CHECK(at({0, 0, 0}) == kEmpty);
  CHECK(at({-5, 0, 0}) == 2);
  CHECK(at({-5, 0, -5}) == kEmpty);
}

}  // namespace runstone::test
