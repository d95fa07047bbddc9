#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <ios>
#include <set>
#include <string>
#include <utility>

#include "client/lettering/font_file.hpp"
#include "client/lettering/text_build.hpp"
#include "client/tools/preview_words.hpp"
#include "client/tools/tool_box.hpp"
#include "common/materials/material_table.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

struct ShapeBench : ToolBench {
  ShapeBench() {
    show_flat();
    box.set_materials(default_material_table());
  }
  /// Presses at the face of a voxel, and predicts what is made.
  ToolAction press(VoxelPos voxel, Direction face = Direction::pos_y,
                   ToolButton button = ToolButton::place) {
    const auto made = box.press(replica, aim_at(voxel, face), button);
    REQUIRE(made);
    predict(*made);
    return *made;
  }
  std::string refusal(VoxelPos voxel, ToolButton button = ToolButton::place) {
    const auto made = box.press(replica, aim_at(voxel, Direction::pos_y), button);
    return made ? std::string() : made.error();
  }
  /// Returns the voxels above the ground that have the held material.
  std::set<VoxelPos> held_voxels() const {
    std::set<VoxelPos> out;
    for (VoxelPos v{-32, -32, -32}; v.z < 32; ++v.z) {
      for (v.y = -32; v.y < 32; ++v.y) {
        for (v.x = -32; v.x < 32; ++v.x) {
          if (at(v) == 2) out.insert(v);
        }
      }
    }
    return out;
  }
};

/// Returns the cells of a text, upright.
std::set<VoxelPos> cells_of_text(std::string_view text, TextStyle style, VoxelPos& sides) {
  const auto build = text_build(*read_font(kDefaultFont).value(), text, style, 2).value();
  sides = build->sides();
  std::set<VoxelPos> out;
  for (VoxelPos c; c.z < sides.z; ++c.z) {
    for (c.y = 0; c.y < sides.y; ++c.y) {
      for (c.x = 0; c.x < sides.x; ++c.x) {
        if (build->at(c)) out.insert(c);
      }
    }
  }
  return out;
}

}  // namespace

TEST_CASE_METHOD(ShapeBench, "a text stands on the wall that was clicked", "[tools]") {
  predict({{FillBox{{{0, 0, -8}, {1, 20, 8}}}, {}, 1}});
  REQUIRE(box.choose("text"));
  REQUIRE(box.set_text("text", "Fg"));
  REQUIRE(box.set_parameter("height", 9));
  REQUIRE(box.set_parameter("thickness", 2));
  press({0, 4, 0}, Direction::pos_x);
  VoxelPos sides;
  std::set<VoxelPos> expected;
  // Read from +x, the text runs along -z, and its layers lie one behind the other along x.
  for (const VoxelPos& c : cells_of_text("Fg", {9, 2}, sides))
    expected.insert({1 + c.z, 4 + c.y, sides.x - 1 - c.x - sides.x / 2});
  CHECK(held_voxels() == expected);
}

TEST_CASE_METHOD(ShapeBench, "a text lies on the ground, and is cut into it", "[tools]") {
  REQUIRE(box.choose("text"));
  REQUIRE(box.set_text("text", "Fg"));
  REQUIRE(box.set_parameter("height", 9));
  REQUIRE(box.set_parameter("place", 1));
  press({0, -1, 0});
  VoxelPos sides;
  std::set<VoxelPos> expected;
  // A player who looks straight down counts as one who looks along +z.
  for (const VoxelPos& c : cells_of_text("Fg", {9, 1}, sides))
    expected.insert({sides.x - 1 - c.x - sides.x / 2, 0, c.y});
  CHECK(held_voxels() == expected);
  press({0, -1, 0}, Direction::pos_y, ToolButton::clear);
  for (const VoxelPos& v : expected) CHECK(at({v.x, -1, v.z}) == kEmpty);
  CHECK(at({sides.x, -1, 0}) == 1);
}

TEST_CASE_METHOD(ShapeBench, "a text that cannot be written is refused with words", "[tools]") {
  REQUIRE(box.choose("text"));
  CHECK(box.set_text("text", "a\nb").error() == "text must be in UTF-8 without control characters");
  CHECK(box.set_text("text", std::string(2000, 'a')).error() == "text has at most 1024 bytes");
  CHECK(box.set_text("speed", "1").error() == "the tool text has no text speed");
  REQUIRE(box.set_text("text", ""));
  CHECK(refusal({0, -1, 0}) == "type a text first");
  REQUIRE(box.set_text("text", "a"));
  REQUIRE(box.set_text("font", "NoSuchFont"));
  CHECK(refusal({0, -1, 0}).starts_with("there is no font NoSuchFont: looked for "));
  REQUIRE(box.set_text("font", kDefaultFont));
  CHECK(refusal({0, -1, 0}).empty());
}

TEST_CASE_METHOD(ShapeBench, "a font is searched once for each change of its name", "[tools]") {
  const TempFolder folder;
  const std::string file = folder / "written later.ttf";
  REQUIRE(box.choose("text"));
  REQUIRE(box.set_text("font", file));
  const std::string missing = refusal({0, -1, 0});
  CHECK(missing.starts_with("cannot read the font: "));
  const FontPtr font = read_font(kDefaultFont).value();
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(font->data()),
             static_cast<std::streamsize>(font->size()));
  CHECK(refusal({0, -1, 0}) == missing);
  REQUIRE(box.set_text("font", kDefaultFont));
  CHECK(refusal({0, -1, 0}).empty());
  REQUIRE(box.set_text("font", file));
  CHECK(refusal({0, -1, 0}).empty());
  // The bytes that were read serve until the name changes.
  std::filesystem::remove(file);
  CHECK(refusal({0, -1, 0}).empty());
}

TEST_CASE_METHOD(ShapeBench, "a polygon is closed by a click on its first or its last corner",
                 "[tools]") {
  REQUIRE(box.choose("polygon"));
  REQUIRE(box.set_parameter("height", 2));
  const bool by_first = GENERATE(true, false);
  for (const VoxelPos corner : {VoxelPos{0, -1, 0}, VoxelPos{6, -1, 0}, VoxelPos{6, -1, 6}})
    CHECK(press(corner).empty());
  CHECK(box.points().size() == 3);
  CHECK_FALSE(press(by_first ? VoxelPos{0, -1, 0} : VoxelPos{6, -1, 6}).empty());
  CHECK(box.points().empty());
  for (VoxelPos v{-1, 0, 0}; v.x <= 7; ++v.x) {
    for (v.z = -1; v.z <= 7; ++v.z) {
      const bool is_inside = v.x <= 6 && v.z >= 0 && v.z <= v.x;
      CHECK(at(v) == (is_inside ? Material{2} : kEmpty));
      CHECK(at({v.x, 1, v.z}) == (is_inside ? Material{2} : kEmpty));
    }
  }
}

TEST_CASE_METHOD(ShapeBench, "a curve ends with a second click on its last place, or is typed",
                 "[tools]") {
  REQUIRE(box.choose("curve"));
  REQUIRE(box.set_parameter("bend", 1));
  press({0, -1, 0});
  press({5, -1, 0});
  CHECK_FALSE(press({5, -1, 0}).empty());
  std::set<VoxelPos> line;
  for (std::int32_t x = 0; x <= 5; ++x) line.insert({x, 0, 0});
  CHECK(held_voxels() == line);
  CHECK(box.typed_count() == std::array<std::size_t, 2>{2, kStrokePointsMax});
  TypedPlaces typed;
  typed.places = {{0, 3, 0}, {0, 3, 2'000}};
  box.type_places(typed);
  CHECK(box.apply_typed(replica, 2).error() == "two places are more than 1024 voxels apart");
  typed.places.pop_back();
  box.type_places(typed);
  CHECK(box.apply_typed(replica, 2).error() == "the tool curve takes 2 to 256 places");
}

TEST_CASE_METHOD(ShapeBench, "the wand copies exactly the connected voxels, and cuts them",
                 "[tools]") {
  predict({{FillBox{{{0, 0, 0}, {3, 1, 1}}}, {}, 2}, {FillBox{{{2, 1, 0}, {3, 4, 1}}}, {}, 2}});
  predict({{FillBox{{{0, 2, 0}, {1, 3, 1}}}, {}, 2}});  // not connected
  const auto before = held_voxels();
  REQUIRE(box.choose("wand"));
  const std::uint64_t changes = box.clipboard_changes();
  const auto words = [&](ToolButton button) {
    TypedPlaces typed;
    typed.button = button;
    typed.places = {{0, 0, 0}};
    box.type_places(typed);
    const Aim aim = aim_at({0, 0, 0}, Direction::pos_y);
    for (unsigned i = 0; i < 2 * ToolBox::kRestCalls; ++i) box.step_preview(replica, aim, 512);
    box.type_places(std::nullopt);
    return preview_words(box);
  };
  CHECK(words(ToolButton::place) == "copies 6 voxels");
  CHECK(words(ToolButton::clear) == "sets 0 and removes 6 voxels");
  for (const auto& [result, expected] :
       {std::pair{1, "selects 6 voxels"}, {2, "selects 6 voxels"}, {3, "deselects 6 voxels"}}) {
    REQUIRE(box.set_parameter("result", result));
    CHECK(words(ToolButton::place) == expected);
    CHECK(words(ToolButton::clear) == "deselects 6 voxels");
  }
  box.hold_select_mode(SelectMode::add);
  CHECK(preview_words(box) == "selects 6 voxels");
  box.hold_select_mode(std::nullopt);
  REQUIRE(box.set_parameter("result", 0));
  CHECK(press({0, 0, 0}).empty());
  CHECK(held_voxels() == before);
  CHECK(box.clipboard_changes() == changes + 1);
  REQUIRE(box.clipboard().build);
  CHECK(box.clipboard().build->touched() == 6);
  CHECK(box.clipboard().build->sides() == VoxelPos{3, 4, 1});
  press({0, 0, 0}, Direction::pos_y, ToolButton::clear);
  CHECK(held_voxels() == std::set<VoxelPos>{{0, 2, 0}});
  CHECK(box.clipboard().build->touched() == 6);
}

TEST_CASE_METHOD(ShapeBench, "the wand takes a material of the selection, and names its limits",
                 "[tools]") {
  predict({{FillBox{{{0, 0, 0}, {2, 1, 1}}}, {}, 2}, {FillBox{{{5, 0, 0}, {6, 1, 1}}}, {}, 2}});
  REQUIRE(box.choose("wand"));
  REQUIRE(box.set_parameter("reach", 1));
  CHECK(refusal({0, 0, 0}) == "nothing is selected");
  box.select(VoxelBox{{0, -4, -4}, {8, 4, 4}});
  press({0, 0, 0});
  CHECK(box.clipboard().build->touched() == 3);
  REQUIRE(box.set_parameter("reach", 0));
  CHECK(refusal({0, -1, 5}) == "the voxels reach ground that is not loaded");
  REQUIRE(box.set_parameter("voxels", 1));
  CHECK(refusal({0, 0, 0}) ==
        "there are more than 1 voxels: choose one material or a higher limit");
  REQUIRE(box.set_parameter("voxels", 100));
  REQUIRE(box.set_parameter("grow", -2));
  CHECK(refusal({0, 0, 0}) == "no voxel is left");
}

TEST_CASE_METHOD(ShapeBench, "an array puts copies along a line", "[tools]") {
  predict({{FillBox{{{-9, 0, -9}, {-8, 3, -8}}}, {}, 4}});
  REQUIRE(box.choose("array"));
  CHECK(refusal({0, -1, 0}).empty());
  CHECK(refusal({12, -1, 0}).empty());
  CHECK(refusal({12, -1, 0}) == "nothing was copied");
  box.select(VoxelBox{{-9, 0, -9}, {-8, 3, -8}});
  REQUIRE(box.copy(replica, true));
  REQUIRE(box.set_parameter("spacing", 4));
  press({0, -1, 0});
  press({12, -1, 0});
  CHECK(press({12, -1, 0}).edits.size() == 4);
  for (std::int32_t x = -2; x <= 14; ++x)
    CHECK(at({x, 2, 0}) == (x >= 0 && x <= 12 && x % 4 == 0 ? Material{4} : kEmpty));
}

TEST_CASE_METHOD(ShapeBench, "the clipboard turns by any angle and is scaled", "[tools]") {
  CHECK(box.reshape({Axis::y, 45, 100}).error() == "nothing was copied");
  predict({{FillBox{{{0, 0, 0}, {10, 1, 1}}}, {}, 2}});
  box.select(VoxelBox{{0, 0, 0}, {10, 1, 1}});
  REQUIRE(box.copy(replica, true));
  REQUIRE(box.reshape({Axis::z, 0, 200}));
  CHECK(box.clipboard().build->sides() == VoxelPos{20, 2, 2});
  CHECK(box.clipboard().build->touched() == 80);
  REQUIRE(box.reshape({Axis::y, 45, 100}));
  CHECK(box.clipboard().build->sides() == VoxelPos{16, 2, 16});
  CHECK(box.reshape({Axis::y, 45, 5}).error() == "the scale must be from 10 to 1000 percent");
}

}  // namespace runstone::test
