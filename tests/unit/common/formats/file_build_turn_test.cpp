#include "common/formats/file_build_turn.hpp"
#include "common/formats/turned_names.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "common/formats/luanti_block.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/schematic_names.hpp"
#include "common/formats/schematic_reader.hpp"
#include "common/formats/schematic_writer.hpp"
#include "common/formats/shape_names.hpp"
#include "common/shapes/shape_faces.hpp"
#include "common/shapes/turned_shape.hpp"
#include "tests/support/formats/file_builds.hpp"

namespace runstone::test {
namespace {

constexpr Orientation kLeft = Orientation{}.rotated_about_y(1);

BuildMaterial block_material(const std::string& name, const std::string& states) {
  return {row_of(material_of_minecraft_block({name, states}, true)), states};
}

std::string text(const BuildMaterial& material) {
  return material.row.name + '|' + material.states;
}

const Format kSchem{"schematic", ".schem", read_schematic, material_of_schematic_block,
                    write_schem};

/// Turns to the left as seen from above: north goes to west.
std::string left(const BuildMaterial& material) {
  const auto out = turned_build_material(material, {Axis::z, Axis::y, Axis::x}, kLeft.flips);
  return out ? text(*out) : "none";
}

/// A cell of each material in a row along x, and another one that makes the front of the build.
FileBuild row_of_materials(const std::vector<BuildMaterial>& materials) {
  const auto count = static_cast<std::int32_t>(materials.size());
  return file_build({count, 2, 3}, materials, [&](VoxelPos at) {
    return static_cast<std::uint16_t>(at.y == 0 ? at.x + 1 : at.z == 0 ? 1 : 0);
  });
}

const std::vector<BuildMaterial>& house() {
  static const std::vector<BuildMaterial> materials = {
      block_material("minecraft:oak_stairs",
                     "facing=east,half=top,shape=inner_left,waterlogged=false"),
      block_material("minecraft:oak_stairs",
                     "facing=north,half=top,shape=inner_left,waterlogged=false"),
      block_material("minecraft:oak_log", "axis=x"),
      block_material("minecraft:oak_fence",
                     "east=true,north=true,south=false,waterlogged=false,west=false"),
      block_material("minecraft:oak_door",
                     "facing=south,half=upper,hinge=right,open=true,powered=false"),
      block_material("minecraft:oak_sign", "rotation=3,waterlogged=false"),
      block_material("minecraft:cobblestone_wall",
                     "east=tall,north=low,south=none,up=true,waterlogged=false,west=none"),
      block_material("minecraft:chest", "facing=west,type=left,waterlogged=false"),
      block_material("minecraft:rail", "shape=ascending_east,waterlogged=false"),
      block_material("minecraft:vine", "east=false,north=true,south=false,up=false,west=true"),
      block_material("minecraft:stone", ""),
  };
  return materials;
}

}  // namespace

TEST_CASE("a turned material has another name and the same states written", "[formats][turn]") {
  CHECK(left(block_material("minecraft:oak_stairs", "facing=north,half=top")) ==
        "minecraft:oak_stairs[facing=west,half=top]|facing=west,half=top");
  CHECK(left(block_material("minecraft:oak_stairs", "half=top")) ==
        "minecraft:oak_stairs[facing=west,half=top]|facing=west,half=top");
  CHECK(left(block_material("minecraft:oak_stairs", "")) == "minecraft:oak_stairs[facing=west]|");
  CHECK(left(block_material("minecraft:oak_log", "axis=x")) == "minecraft:oak_log[axis=z]|axis=z");
  CHECK(left(block_material("minecraft:oak_log", "axis=y")) == "minecraft:oak_log|axis=y");
  CHECK(left(block_material("minecraft:stone", "")) == "minecraft:stone|");
  CHECK(left(file_material("stairs[facing=north]", "", {1, 2, 3, 255})) == "stairs[facing=west]|");
  CHECK(left(file_material("stone", "colour=5", {1, 2, 3, 255})) == "stone|colour=5");
  // A name that says nothing of the states stays.
  CHECK(left(file_material("minecraft:oak_stairs", "facing=east", {1, 2, 3, 255})) ==
        "minecraft:oak_stairs|facing=north");
}

TEST_CASE("a turned node of Luanti has another param2 in its name and states", "[formats][turn]") {
  const auto node = [](const std::string& states) {
    const MaterialInfo info = material_of_luanti_node({"stairs:stair_wood", states}, true);
    return BuildMaterial{row_of(info), states};
  };
  CHECK(text(node("param2=1")) == "stairs:stair_wood[param2=1]|param2=1");
  BuildMaterial now = node("param2=1");
  for (int i = 0; i < 4; ++i) {
    const auto next = turned_build_material(now, {Axis::z, Axis::y, Axis::x}, kLeft.flips);
    REQUIRE(next);
    CHECK(text(*next) != text(now));
    CHECK(next->row.shape == shape_of_material_name(next->row.name));
    now = *next;
  }
  CHECK(text(now) == text(node("param2=1")));
  CHECK(now == node("param2=1"));
}

TEST_CASE("a turned node keeps its other states", "[formats][turn]") {
  const auto node = [](const std::string& name, const std::string& states) {
    BuildMaterial out = file_material(name, states, {9, 9, 9, 255});
    out.row.shape = shape_of_material_name(name).value_or(Shape{});
    return out;
  };
  CHECK(left(node("stairs:stair_wood[a=b,param2=1]", "a=b,param2=1")) ==
        "stairs:stair_wood[a=b,param2=2]|a=b,param2=2");
  CHECK(left(node("stairs:stair_wood", "a=b")) == "stairs:stair_wood[a=b,param2=1]|a=b,param2=1");
  CHECK(left(node("stairs:stair_wood[a=b,param2=3]", "")) == "stairs:stair_wood[a=b]|");
}

TEST_CASE("a node with a param2 gets no states of Minecraft", "[formats][turn]") {
  const auto node = [](const std::string& name, const std::string& states) {
    BuildMaterial out = file_material(name, states, {9, 9, 9, 255});
    out.row.shape = shape_of_material_name(name).value_or(Shape{});
    return out;
  };
  CHECK(left(node("mcl_core:ladder[param2=5]", "param2=5")) ==
        "mcl_core:ladder[param2=3]|param2=3");
  CHECK(left(node("mod:ladder", "param2=3")) == "none");
  CHECK(left(node("mod:fir_door", "param2=3")) == "none");
  CHECK(left(node("mod:chest", "param2=3")) == "mod:chest|param2=3");
  CHECK(left(node("mod:fir_wood", "param2=3")) == "mod:fir_wood|param2=3");
}

TEST_CASE("a shape of its own is turned with its material", "[formats][turn]") {
  BuildMaterial bench = file_material("bench", "", {9, 9, 9, 255});
  bench.row.shape = {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 4}}, {{0, 8, 0}, {4, 16, 4}}}};
  const auto once = turned_build_material(bench, {Axis::z, Axis::y, Axis::x}, kLeft.flips);
  REQUIRE(once);
  CHECK(once->row.shape == turned_about_y(bench.row.shape, 3));
  CHECK(once->row.name == "bench");
}

TEST_CASE("a shape that would have too many faces stays as it lies, and is counted",
          "[formats][turn][shapes]") {
  BuildMaterial lattice = file_material("lattice", "", {9, 9, 9, 255});
  lattice.row.shape = {ShapeForm::boxes,
                       {{{12, 0, 0}, {13, 16, 15}},
                        {{2, 12, 1}, {16, 13, 16}},
                        {{0, 0, 6}, {15, 15, 7}},
                        {{8, 0, 3}, {9, 16, 15}},
                        {{0, 8, 3}, {16, 9, 16}},
                        {{0, 0, 12}, {15, 15, 13}},
                        {{10, 3, 0}, {11, 13, 15}},
                        {{1, 2, 0}, {16, 3, 14}},
                        {{0, 0, 10}, {14, 14, 11}},
                        {{4, 1, 0}, {5, 16, 16}},
                        {{2, 10, 0}, {16, 11, 14}},
                        {{1, 2, 4}, {14, 16, 5}},
                        {{2, 3, 3}, {3, 16, 16}},
                        {{1, 4, 3}, {16, 5, 16}}}};
  REQUIRE(ShapeFaces(lattice.row.shape).faces().size() == kShapeFacesMax);
  REQUIRE(ShapeFaces(turned_about_y(lattice.row.shape, 3)).faces().size() > kShapeFacesMax);
  const auto done = turned_file_build(row_of_materials({lattice}), kLeft);
  REQUIRE(done);
  CHECK(done->stuck == 1);
  CHECK(done->build.materials == std::vector{lattice});
  CHECK(validate_build_materials(done->build.materials));
  lattice.row.shape = turned_about_y(lattice.row.shape, 3);
  const auto refused = validate_build_materials(std::vector{lattice});
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("a material that no state turns stays, and is counted", "[formats][turn]") {
  const FileBuild build = row_of_materials(
      {block_material("minecraft:torch", ""), block_material("minecraft:stone", "")});
  const auto done = turned_file_build(build, Orientation{}.mirrored(Axis::y));
  REQUIRE(done);
  CHECK(done->stuck == 1);
  CHECK(stuck_notice(done->stuck) ==
        "1 material has no state for the new direction, and lies as before");
  CHECK(stuck_notice(0).empty());
}

TEST_CASE("a build that is turned four times, or mirrored twice, is equal", "[formats][turn]") {
  const FileBuild build = row_of_materials(house());
  FileBuild now = build;
  for (int i = 0; i < 4; ++i) {
    auto next = turned_file_build(now, kLeft);
    REQUIRE(next);
    CHECK(next->stuck == 0);
    CHECK(cell_texts(next->build) != cell_texts(now));
    now = std::move(next->build);
  }
  CHECK(cell_texts(now) == cell_texts(build));
  CHECK(now.info == build.info);
  for (const Axis axis : {Axis::x, Axis::z}) {
    auto once = turned_file_build(build, Orientation{}.mirrored(axis));
    REQUIRE(once);
    CHECK(cell_texts(once->build) != cell_texts(build));
    const auto twice = turned_file_build(once->build, Orientation{}.mirrored(axis));
    REQUIRE(twice);
    CHECK(cell_texts(twice->build) == cell_texts(build));
  }
}

TEST_CASE("a cell of a turned build is where it belongs, and faces there", "[formats][turn]") {
  // Stairs at the east end that ascend to the east.
  const FileBuild build = file_build(
      {3, 1, 2}, {block_material("minecraft:oak_stairs", "facing=east")},
      [](VoxelPos at) { return static_cast<std::uint16_t>(at == VoxelPos{2, 0, 0} ? 1 : 0); });
  const auto done = turned_file_build(build, kLeft);
  REQUIRE(done);
  CHECK(done->build.build->sides() == VoxelPos{2, 1, 3});
  CHECK(done->build.info.sides == BuildSides{2, 1, 3});
  // East goes to north.
  REQUIRE(done->build.build->at({0, 0, 0}));
  CHECK(done->build.materials.at(0).states == "facing=north");
  CHECK(done->build.materials.at(0).row.name == "minecraft:oak_stairs");
}

TEST_CASE("a schematic that is read, turned four times and written is equal", "[formats][turn]") {
  const FileBuild build = row_of_materials(house());
  const auto file = written(write_schem, build);
  REQUIRE(file);
  auto now = read_foreign_build(kSchem, *file, {});
  REQUIRE(now);
  const FileBuild first = *now;
  for (int i = 0; i < 4; ++i) {
    auto next = turned_file_build(*now, kLeft);
    REQUIRE(next);
    const auto bytes = written(write_schem, next->build);
    REQUIRE(bytes);
    now = read_foreign_build(kSchem, *bytes, {});
    REQUIRE(now);
  }
  CHECK(cell_texts(*now) == cell_texts(first));
  CHECK(now->materials == first.materials);
  const auto last = written(write_schem, *now), again = written(write_schem, first);
  REQUIRE(last);
  REQUIRE(again);
  CHECK(*last == *again);
}

}  // namespace runstone::test
