#include "client/tools/turned_materials.hpp"

#include <catch2/catch.hpp>

#include "client/tools/symmetry.hpp"
#include "client/tools/tool_box.hpp"
#include "common/formats/turned_names.hpp"
#include "tests/unit/client/tools/hands_table.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

const Orientation kTurnLeft = Orientation{}.rotated_about_y(1);

/// All stairs of one wood that stand, a slab, a torch, and a family without states in its names.
MaterialTable stairs_table() {
  MaterialTable table =
      hands_table({"stone", "minecraft:oak_stairs", "minecraft:oak_stairs[facing=east]",
                   "minecraft:oak_stairs[facing=south]", "minecraft:oak_stairs[facing=west]",
                   "minecraft:oak_slab", "minecraft:torch", "minecraft:birch_stairs"});
  for (const auto& [name, box] : {std::pair{"bench[a]", ShapeBox{{0, 0, 0}, {16, 8, 4}}},
                                  std::pair{"bench[b]", ShapeBox{{0, 0, 0}, {4, 8, 16}}}}) {
    MaterialInfo info;
    info.name = name;
    info.shape = {ShapeForm::boxes, {box}};
    REQUIRE(table.add(std::move(info)));
  }
  return table;
}

std::string turned_name(const MaterialTable& table, std::string_view name,
                        const Orientation& orientation) {
  const auto out = turned_material(id_in(table, name), orientation, table);
  return out ? table[*out].name : "none";
}

}  // namespace

TEST_CASE("a material of a world becomes the one with the turned name", "[tools][hands]") {
  const MaterialTable table = stairs_table();
  CHECK(turned_name(table, "minecraft:oak_stairs", kTurnLeft) ==
        "minecraft:oak_stairs[facing=west]");
  CHECK(turned_name(table, "minecraft:oak_stairs[facing=west]", kTurnLeft) ==
        "minecraft:oak_stairs[facing=south]");
  CHECK(turned_name(table, "minecraft:oak_stairs[facing=east]", Orientation{}.mirrored(Axis::x)) ==
        "minecraft:oak_stairs[facing=west]");
  CHECK(turned_name(table, "minecraft:oak_slab", kTurnLeft) == "minecraft:oak_slab");
  CHECK(turned_name(table, "stone", kTurnLeft) == "stone");
  CHECK(turned_material(kEmpty, kTurnLeft, table) == kEmpty);
  CHECK(turned_material(500, kTurnLeft, table) == Material{500});  // the table does not know it
}

TEST_CASE("without the name, a material becomes the one of its family with the turned shape",
          "[tools][hands]") {
  const MaterialTable table = stairs_table();
  CHECK(turned_name(table, "bench[a]", kTurnLeft) == "bench[b]");
  CHECK(turned_name(table, "bench[b]", kTurnLeft) == "none");
  CHECK(turned_name(table, "minecraft:birch_stairs", kTurnLeft) == "none");
  CHECK(turned_name(table, "minecraft:torch", Orientation{}.mirrored(Axis::y)) == "none");
}

TEST_CASE("a palette is turned entry by entry, and the stuck ones are counted", "[tools][hands]") {
  const MaterialTable table = stairs_table();
  const std::vector<Material> palette = {id_in(table, "stone"),
                                         id_in(table, "minecraft:birch_stairs"),
                                         id_in(table, "minecraft:oak_stairs")};
  const TurnedMaterials now = turned_materials(palette, kTurnLeft, table);
  CHECK(now.ids == std::vector<std::optional<Material>>{
                       palette[0], palette[1], id_in(table, "minecraft:oak_stairs[facing=west]")});
  CHECK(now.is_changed);
  CHECK(now.stuck == 1);
  CHECK(stuck_text(1) == "1 material has no turned form in this world, and lies as before");
  CHECK_FALSE(turned_materials(std::vector<Material>{1}, kTurnLeft, table).is_changed);
}

TEST_CASE("the clipboard turns its materials, and four turns give it back", "[tools][hands]") {
  ToolBench bench;
  bench.show_flat();
  const MaterialTable table = stairs_table();
  static_cast<void>(bench.box.set_materials(table));
  const Material north = id_in(table, "minecraft:oak_stairs"),
                 east = id_in(table, "minecraft:oak_stairs[facing=east]"),
                 west = id_in(table, "minecraft:oak_stairs[facing=west]"),
                 birch = id_in(table, "minecraft:birch_stairs");
  bench.predict({{SetVoxel{{0, 0, 0}}, {}, north},
                 {SetVoxel{{1, 0, 0}}, {}, east},
                 {SetVoxel{{2, 0, 0}}, {}, birch}});
  bench.box.select(VoxelBox{{0, 0, 0}, {3, 1, 2}});
  REQUIRE(bench.box.copy(bench.replica, true));
  const Build before = *bench.box.clipboard().build;
  REQUIRE(bench.box.rotate(1));
  CHECK(bench.box.turn_notice() == stuck_text(1));
  const Build& once = *bench.box.clipboard().build;
  CHECK(once.sides() == VoxelPos{2, 1, 3});
  // West to east becomes south to north.
  CHECK(once.at({0, 0, 2}) == west);
  CHECK(once.at({0, 0, 1}) == north);
  CHECK(once.at({0, 0, 0}) == birch);
  REQUIRE(bench.box.clipboard_rows().size() == once.palette().size());
  for (std::size_t i = 0; i < once.palette().size(); ++i)
    CHECK(bench.box.clipboard_rows()[i].name == table[once.palette()[i]].name);
  for (int i = 0; i < 3; ++i) REQUIRE(bench.box.rotate(1));
  for (std::int32_t x = 0; x < 3; ++x)
    CHECK(bench.box.clipboard().build->at({x, 0, 0}) == before.at({x, 0, 0}));
  REQUIRE(bench.box.mirror(Axis::x));
  CHECK(bench.box.clipboard().build->at({1, 0, 0}) == west);
  REQUIRE(bench.box.rotate(0));
  CHECK(bench.box.turn_notice().empty());
}

TEST_CASE("before a world is open, a material without a state for the new direction stays as it is",
          "[tools][hands]") {
  const MaterialTable table = stairs_table();
  ToolBench bench;
  bench.show_flat();
  static_cast<void>(bench.box.set_materials(table));
  bench.predict({{SetVoxel{{0, 0, 0}}, {}, id_in(table, "minecraft:oak_stairs")},
                 {SetVoxel{{1, 0, 0}}, {}, id_in(table, "minecraft:torch")}});
  bench.box.select(VoxelBox{{0, 0, 0}, {2, 1, 1}});
  REQUIRE(bench.box.copy(bench.replica, true));
  const std::span<const MaterialRow> rows = bench.box.clipboard_rows();
  ToolBox closed;
  static_cast<void>(closed.set_clipboard(bench.box.clipboard().build, EmptyCells::skipped,
                                         {rows.begin(), rows.end()}));
  // Stairs have a state for upside down, and a torch has none.
  REQUIRE(closed.mirror(Axis::y));
  CHECK(closed.turn_notice() == stuck_notice(1));
  std::size_t torches = 0, stairs = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const MaterialRow& row = closed.clipboard_rows()[i];
    torches += row == rows[i] && row.name == "minecraft:torch" ? 1 : 0;
    stairs += row.name == "minecraft:oak_stairs[half=top]" && row.shape != rows[i].shape ? 1 : 0;
  }
  CHECK(torches == 1);
  CHECK(stairs == 1);
  REQUIRE(closed.rotate(1));
  CHECK(closed.turn_notice().empty());
}

TEST_CASE("symmetric copies have mirrored materials", "[tools][hands]") {
  const MaterialTable table = stairs_table();
  const Material east = id_in(table, "minecraft:oak_stairs[facing=east]"),
                 west = id_in(table, "minecraft:oak_stairs[facing=west]");
  CHECK(mirrored({SetVoxel{{3, 0, 0}}, {MaskKind::only_material, west}, east}, Axis::x, 0, table) ==
        EditDescriptor{SetVoxel{{-3, 0, 0}}, {MaskKind::only_material, east}, west});
  // A copy onto itself keeps the material of the click.
  CHECK(with_copies({{SetVoxel{{0, 0, 0}}, {}, east}}, {SymmetryKind::x, 0, 0}, table) ==
        std::vector<EditDescriptor>{{SetVoxel{{0, 0, 0}}, {}, east}});
  // The copies of one clipboard have one clipboard. They are too far apart to be merged.
  const auto clipboard = Clipboard::of({east}, uniform_chunk(Extent{2, 1, 1}, 1));
  REQUIRE(clipboard);
  const auto copies = with_copies({{Paste{{300, 0, 0}, *clipboard, {}}, {}, kEmpty},
                                   {Paste{{900, 0, 0}, *clipboard, {}}, {}, kEmpty}},
                                  {SymmetryKind::x, 0, 0}, table);
  REQUIRE(copies.size() == 4);
  CHECK(std::get<Paste>(copies[1].shape).clipboard != *clipboard);
  CHECK(std::get<Paste>(copies[1].shape).clipboard == std::get<Paste>(copies[3].shape).clipboard);
  ToolBench bench;
  bench.show_flat();
  static_cast<void>(bench.box.set_materials(table));
  bench.predict({{SetVoxel{{0, 0, 0}}, {}, east}});
  bench.box.select(VoxelBox{{0, 0, 0}, {1, 1, 1}});
  REQUIRE(bench.box.copy(bench.replica, true));
  bench.box.set_symmetry({SymmetryKind::x, 0, 0});
  REQUIRE(bench.box.choose("paste"));
  const auto pasted =
      bench.box.press(bench.replica, bench.aim_at({5, -1, 5}, Direction::pos_y), ToolButton::place);
  REQUIRE(pasted);
  bench.predict(*pasted);
  CHECK(bench.at({5, 0, 5}) == east);
  CHECK(bench.at({-5, 0, 5}) == west);
  // A build that no descriptor holds.
  MirroredBuilds builds;
  const auto build = builds.mirrored(bench.box.clipboard().build, true, false, table);
  REQUIRE(build);
  CHECK((*build)->at({0, 0, 0}) == west);
}

TEST_CASE("a clipboard from elsewhere takes another member before the nearest colour",
          "[tools][hands]") {
  ToolBench bench;
  bench.show_flat();
  static_cast<void>(bench.box.set_materials(stairs_table()));
  bench.predict({{SetVoxel{{0, 0, 0}}, {}, 3}});
  bench.box.select(VoxelBox{{0, 0, 0}, {1, 1, 1}});
  REQUIRE(bench.box.copy(bench.replica, true));
  const MaterialTable other = hands_table({"stone", "minecraft:oak_stairs[half=top]"});
  CHECK(bench.box.set_materials(other) ==
        "other states or the nearest colours take the place of materials that this world lacks: "
        "minecraft:oak_stairs[facing=east]");
  CHECK(bench.box.clipboard().build->at({0, 0, 0}) == Material{2});
}

}  // namespace runstone::test
