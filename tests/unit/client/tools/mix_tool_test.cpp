#include <catch2/catch.hpp>

#include "client/tools/tool_box.hpp"
#include "client/tools/tool_command.hpp"
#include "common/materials/material_table.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

/// Flat ground of grass (material 1) below y = 0, and the tool mix.
struct MixBench : ToolBench {
  MixBench() {
    show_flat();
    box.set_materials(default_material_table());
    REQUIRE(box.choose("mix"));
  }
  Material id(std::string_view name) const { return *default_material_table().find(name); }
  ToolEdits click(VoxelPos voxel, ToolButton button = ToolButton::place) {
    return box.press(replica, aim_at(voxel, Direction::pos_y), button);
  }
  std::string refusal(VoxelPos voxel) {
    REQUIRE(click(voxel));
    const auto made = click(voxel);
    return made ? "" : made.error();
  }
  std::size_t count(Material material) const {
    std::size_t out = 0;
    for (std::int32_t x = -32; x < 32; ++x) {
      for (std::int32_t y = -32; y < 32; ++y) {
        for (std::int32_t z = -32; z < 32; ++z) out += at({x, y, z}) == material ? 1 : 0;
      }
    }
    return out;
  }
};

}  // namespace

TEST_CASE_METHOD(MixBench, "the tool mix gives a box the materials of a pattern", "[tools]") {
  REQUIRE(box.set_text("pattern", "60% stone, 40% gravel where exposed"));
  CHECK(box.tool().texts()[0].chips ==
        std::vector<std::string>{"60% stone", "40% gravel", "where", "exposed"});
  REQUIRE(click({-10, -3, -10})->empty());
  const auto made = click({9, -1, 9});
  REQUIRE(made);
  predict(*made);
  const std::size_t stone = count(id("stone")), gravel = count(id("gravel"));
  CHECK(stone + gravel == 400);
  CHECK(stone > 200);
  CHECK(gravel > 120);
  CHECK(at({0, -2, 0}) == 1);
  // The same pattern gives these voxels the materials that they have already.
  REQUIRE(click({-10, -3, -10}));
  CHECK(click({9, -1, 9}).error() == "the pattern changes no voxel there");
}

TEST_CASE_METHOD(MixBench, "the tool mix works in the selection, and the left button clears",
                 "[tools]") {
  REQUIRE(box.set_text("pattern", "stone where on grass"));
  REQUIRE(box.set_parameter("region", 1));
  CHECK(click({0, -1, 0}).error() == "nothing is selected");
  box.select(VoxelBox{{-4, -3, -4}, {4, 2, 4}});
  const auto cleared = click({0, -1, 0}, ToolButton::clear);
  REQUIRE(cleared);
  predict(*cleared);
  CHECK(at({0, -3, 0}) == kEmpty);
  CHECK(at({0, -1, 0}) == kEmpty);
  CHECK(at({0, -4, 0}) == 1);
  const auto placed = click({20, -1, 20});
  REQUIRE(placed);
  predict(*placed);
  CHECK(count(id("stone")) == 64);
  CHECK(at({3, -3, 3}) == id("stone"));
}

TEST_CASE_METHOD(MixBench, "a wrong pattern is kept with its mistake, and nothing is changed",
                 "[tools]") {
  CHECK(refusal({0, -1, 0}) == "type a pattern first, such as 70% stone, 30% gravel");
  REQUIRE(box.set_text("pattern", "stone,"));
  CHECK(box.tool().texts()[0].text == "stone,");
  CHECK(box.tool().texts()[0].error == "column 7: found the end but expected a material");
  CHECK(box.tool().texts()[0].chips.empty());
  CHECK(refusal({0, -1, 0}) == "pattern: column 7: found the end but expected a material");
  REQUIRE(box.set_text("pattern", "cheese"));
  CHECK(box.tool().texts()[0].error.empty());
  CHECK(refusal({0, -1, 0}) == "pattern: column 1: the world has no material \"cheese\"");
  REQUIRE(box.set_text("pattern", "stone"));
  CHECK(refusal({31, -1, 31}).empty());
  CHECK(refusal({40, -1, 0}) == "a chunk of the box is not loaded");
  CHECK(box.set_text("where", "solid").error() == "the tool mix has no text where");
}

TEST_CASE_METHOD(MixBench, "a box of many edits is one paste whose numbers are exact", "[tools]") {
  REQUIRE(box.set_text("pattern", "stone, gravel where is grass"));
  REQUIRE(box.set_parameter("region", 1));
  box.select(VoxelBox{{-32, -32, -32}, {32, 32, 32}});
  const Aim aim = aim_at({0, -1, 0}, Direction::pos_y);
  for (int i = 0; i < 200; ++i) box.step_preview(replica, aim, 512);
  REQUIRE(box.preview_refusal().empty());
  CHECK(box.build_preview().is_exact());
  CHECK(box.build_preview().placed_voxels() == 64U * 32 * 64);
  CHECK(box.build_preview().removed_voxels() == 0);
  const auto made = click({0, -1, 0});
  REQUIRE(made);
  REQUIRE(made->pastes.size() == 1);
  predict(*made);
  CHECK(count(1) == 0);
  CHECK(count(kEmpty) == 64U * 32 * 64);
}

TEST_CASE_METHOD(MixBench, "typed corners of the tool mix may lie in the air", "[tools]") {
  TypedPlaces typed;
  typed.places = {{0, 5, 0}, {3, 8, 3}};
  REQUIRE(carry_out(box, replica, 2, TextChange{"pattern", "glass"}));
  REQUIRE(carry_out(box, replica, 2, PlacesChange{typed}));
  const auto made = carry_out(box, replica, 2, TypedApply{});
  REQUIRE(made);
  predict(*made);
  CHECK(count(id("glass")) == 64);
}

TEST_CASE_METHOD(MixBench, "terrain and path take a filter and a mix", "[tools]") {
  REQUIRE(box.choose("terrain"));
  REQUIRE(box.set_parameter("radius", 8));
  REQUIRE(box.set_parameter("falloff", 3));
  REQUIRE(box.set_parameter("mode", 6));
  REQUIRE(box.set_parameter("strength", 1));
  REQUIRE(box.set_text("where", "not noise 50%"));
  REQUIRE(box.set_text("material", "stone, gravel"));
  const auto stroke = [&](Material held) {
    REQUIRE(box.press(replica, aim_at({0, -1, 0}, Direction::pos_y, held), ToolButton::place));
    const auto made = box.release(replica, aim_at({0, -1, 0}, Direction::pos_y, held));
    REQUIRE(made);
    predict(*made);
  };
  stroke(kEmpty);
  const std::size_t stone = count(id("stone")), gravel = count(id("gravel"));
  CHECK(stone > 30);
  CHECK(gravel > 30);
  CHECK(stone + gravel < 150);  // of some two hundred
  REQUIRE(box.set_text("material", ""));
  REQUIRE(box.set_text("where", "is gravel"));
  stroke(id("snow"));
  CHECK(count(id("snow")) == gravel);
  CHECK(count(id("stone")) == stone);
  REQUIRE(box.choose("path"));
  REQUIRE(box.set_text("where", "is snow"));
  REQUIRE(box.set_text("material", "brick"));
  REQUIRE(box.set_parameter("width", 64));
  stroke(kEmpty);
  CHECK(count(id("brick")) == gravel);
}

}  // namespace runstone::test
