#include "client/tools/voxel_joins.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "common/formats/minecraft_blocks.hpp"
#include "tests/unit/client/tools/hands_table.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

/// Every member of a fence, a pane and a wall.
MaterialTable joins_table() {
  MaterialTable out =
      hands_table({"stone", "water", "minecraft:oak_leaves", "minecraft:oak_stairs",
                   "minecraft:oak_fence_gate", "minecraft:oak_fence_gate[facing=east]",
                   "minecraft:nether_brick_fence", "minecraft:nether_brick_fence[west=true]"});
  const auto add = [&](std::string name) {
    MaterialInfo info;
    info.shape = shape_of_material_name(name).value_or(Shape{});
    REQUIRE_FALSE(info.shape.is_cube());
    info.name = std::move(name);
    REQUIRE(out.add(std::move(info)));
  };
  for (unsigned bits = 0; bits < 16; ++bits) {
    for (const auto& [block, value] :
         {std::pair{"minecraft:oak_fence", "true"}, std::pair{"minecraft:glass_pane", "true"},
          std::pair{"minecraft:cobblestone_wall", "low"}}) {
      std::string states;
      unsigned bit = 1;
      for (const char* side : {"east", "north", "south", "west"}) {
        if ((bits & bit) != 0)
          states += (states.empty() ? "" : ",") + std::string(side) + "=" + value;
        bit *= 2;
      }
      add(minecraft_material_name({block, states}));
    }
  }
  add("minecraft:cobblestone_wall[east=low,up=false,west=low]");
  return out;
}

struct JoinBench {
  MaterialTable table = joins_table();
  std::map<VoxelPos, Material> voxels;
  bool is_known = true;

  void set(VoxelPos at, std::string_view name) { voxels[at] = id_in(table, name); }
  std::vector<EditDescriptor> edits(VoxelPos at, std::string_view name) const {
    return joined_edits(at, name.empty() ? kEmpty : id_in(table, name), table,
                        [&](VoxelPos pos) -> std::optional<Material> {
                          if (!is_known) return std::nullopt;
                          const auto found = voxels.find(pos);
                          return found == voxels.end() ? kEmpty : found->second;
                        });
  }
  /// Carries out the edits, and returns their number.
  std::size_t place(VoxelPos at, std::string_view name) {
    const auto made = edits(at, name);
    for (const EditDescriptor& edit : made) {
      REQUIRE(validate(edit));
      Material& voxel = voxels[std::get<SetVoxel>(edit.shape).at];
      if (edit.mask.kind == MaskKind::only_material) CHECK(voxel == edit.mask.material);
      voxel = edit.material;
    }
    return made.size();
  }
  /// Fills or clears a box, and returns the number of edits.
  std::size_t fill(const VoxelBox& box, std::string_view name, Mask mask = {}) {
    const Material material = name.empty() ? kEmpty : id_in(table, name);
    const ToolAction made =
        joined_box({FillBox{box}, mask, material}, table,
                   [&](VoxelPos pos) -> std::optional<Material> { return at(pos); });
    CHECK(made.has_followers == (made.edits.size() > 1));
    for (const EditDescriptor& edit : made.edits) {
      REQUIRE(validate(edit));
      const auto set = [&](VoxelPos pos, Material now) {
        if (edit.mask.admits(at(pos))) voxels[pos] = now;
      };
      if (const auto* one = std::get_if<SetVoxel>(&edit.shape)) {
        set(one->at, edit.material);
      } else if (const auto* paste = std::get_if<Paste>(&edit.shape)) {
        for_each_touched(*paste, set);
      } else {
        for_each_voxel(std::get<FillBox>(edit.shape).box,
                       [&](VoxelPos pos) { set(pos, edit.material); });
      }
    }
    return made.edits.size();
  }
  Material at(VoxelPos pos) const {
    const auto found = voxels.find(pos);
    return found == voxels.end() ? kEmpty : found->second;
  }
  template <class Visit>
  static void for_each_voxel(const VoxelBox& box, const Visit& visit) {
    for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        for (std::int32_t x = box.min.x; x < box.max.x; ++x) visit(VoxelPos{x, y, z});
      }
    }
  }
  template <class Set>
  static void for_each_touched(const Paste& paste, const Set& set) {
    const Extent sides = paste.clipboard->extent();
    for_each_voxel({{0, 0, 0}, {sides.x, sides.y, sides.z}}, [&](VoxelPos in) {
      const auto cell =
          paste.clipboard->at({static_cast<std::uint8_t>(in.x), static_cast<std::uint8_t>(in.y),
                               static_cast<std::uint8_t>(in.z)});
      if (cell) set({paste.at.x + in.x, paste.at.y + in.y, paste.at.z + in.z}, *cell);
    });
  }
  std::string name(VoxelPos at) const {
    const std::string& full = table[voxels.at(at)].name;
    return full.substr(full.find(':') + 1);
  }
};

constexpr VoxelPos kHereVoxel{0, 0, 0}, kEastVoxel{1, 0, 0}, kWestVoxel{-1, 0, 0},
    kNorthVoxel{0, 0, -1}, kSouthVoxel{0, 0, 1};

}  // namespace

TEST_CASE_METHOD(JoinBench, "fences in a row join, and part when one is removed",
                 "[tools][hands]") {
  CHECK(place(kHereVoxel, "minecraft:oak_fence") == 1);
  CHECK(name(kHereVoxel) == "oak_fence");
  CHECK(place(kEastVoxel, "minecraft:oak_fence") == 2);
  CHECK(name(kHereVoxel) == "oak_fence[east=true]");
  CHECK(name(kEastVoxel) == "oak_fence[west=true]");
  // The states of the held member do not matter.
  CHECK(place(kWestVoxel, "minecraft:oak_fence[north=true]") == 2);
  CHECK(name(kWestVoxel) == "oak_fence[east=true]");
  CHECK(name(kHereVoxel) == "oak_fence[east=true,west=true]");
  CHECK(place(kHereVoxel, "") == 3);
  CHECK(name(kEastVoxel) == "oak_fence");
  CHECK(name(kWestVoxel) == "oak_fence");
}

TEST_CASE_METHOD(JoinBench, "a cross has five edits", "[tools][hands]") {
  for (const VoxelPos at : {kEastVoxel, kWestVoxel, kNorthVoxel, kSouthVoxel})
    place(at, "minecraft:glass_pane");
  CHECK(place(kHereVoxel, "minecraft:glass_pane") == 5);
  CHECK(name(kHereVoxel) == "glass_pane[east=true,north=true,south=true,west=true]");
  CHECK(name(kSouthVoxel) == "glass_pane[north=true]");
}

TEST_CASE_METHOD(JoinBench, "cubes and sides that are filled are joined, other voxels are not",
                 "[tools][hands]") {
  set(kEastVoxel, "stone");
  set(kWestVoxel, "minecraft:oak_leaves");
  set(kNorthVoxel, "minecraft:oak_stairs");  // its full side is north
  set(kSouthVoxel, "minecraft:oak_stairs");
  CHECK(place(kHereVoxel, "minecraft:oak_fence") == 1);
  CHECK(name(kHereVoxel) == "oak_fence[east=true,south=true]");
  // A cube beside a fence changes it.
  place({5, 0, 5}, "minecraft:oak_fence");
  CHECK(place({6, 0, 5}, "stone") == 2);
  CHECK(name({5, 0, 5}) == "oak_fence[east=true]");
}

TEST_CASE_METHOD(JoinBench, "fences join gates along their sides, and only fences of their kind",
                 "[tools][hands]") {
  set(kEastVoxel, "minecraft:oak_fence_gate");  // it faces north, so it spans x
  set(kSouthVoxel, "minecraft:oak_fence_gate");
  set(kNorthVoxel, "minecraft:cobblestone_wall");
  set(kWestVoxel, "minecraft:nether_brick_fence");
  place(kHereVoxel, "minecraft:oak_fence");
  CHECK(name(kHereVoxel) == "oak_fence[east=true]");
  CHECK(name(kNorthVoxel) == "cobblestone_wall");
  CHECK(name(kWestVoxel) == "nether_brick_fence");
  set(kSouthVoxel, "minecraft:oak_fence_gate[facing=east]");
  place(kHereVoxel, "minecraft:glass_pane");
  CHECK(name(kHereVoxel) == "glass_pane[north=true]");
  place(kHereVoxel, "minecraft:cobblestone_wall");
  CHECK(name(kHereVoxel) == "cobblestone_wall[east=low,north=low,south=low]");
}

TEST_CASE_METHOD(JoinBench, "a straight wall has no post", "[tools][hands]") {
  set(kEastVoxel, "minecraft:cobblestone_wall");
  set(kWestVoxel, "minecraft:cobblestone_wall");
  CHECK(place(kHereVoxel, "minecraft:cobblestone_wall") == 3);
  CHECK(name(kHereVoxel) == "cobblestone_wall[east=low,up=false,west=low]");
  CHECK(name(kEastVoxel) == "cobblestone_wall[west=low]");
  CHECK(place(kNorthVoxel, "minecraft:cobblestone_wall") == 2);
  CHECK(name(kHereVoxel) == "cobblestone_wall[east=low,north=low,west=low]");
}

TEST_CASE_METHOD(JoinBench, "a neighbour keeps its other sides", "[tools][hands]") {
  set(kEastVoxel, "minecraft:oak_fence[north=true]");  // as it was imported
  place(kHereVoxel, "minecraft:oak_fence");
  CHECK(name(kEastVoxel) == "oak_fence[north=true,west=true]");
}

TEST_CASE_METHOD(JoinBench, "only members of the table are set", "[tools][hands]") {
  set(kEastVoxel, "minecraft:nether_brick_fence");
  CHECK(place(kHereVoxel, "minecraft:nether_brick_fence") == 2);
  CHECK(name(kHereVoxel) == "nether_brick_fence");  // one that joins east is missing
  CHECK(name(kEastVoxel) == "nether_brick_fence[west=true]");
  is_known = false;
  CHECK(place({9, 0, 9}, "minecraft:oak_fence") == 1);
}

TEST_CASE_METHOD(JoinBench, "a fence that fills a line joins, and its neighbours join it",
                 "[tools][hands]") {
  set(kWestVoxel, "stone");
  set({5, 0, 0}, "minecraft:oak_fence[south=true]");
  set({2, 0, -1}, "minecraft:oak_fence");
  CHECK(fill({{0, 0, 0}, {5, 2, 1}}, "minecraft:oak_fence[north=true]") == 3);
  CHECK(name(kHereVoxel) == "oak_fence[east=true,west=true]");
  CHECK(name(kEastVoxel) == "oak_fence[east=true,west=true]");
  CHECK(name({2, 0, 0}) == "oak_fence[east=true,north=true,west=true]");
  CHECK(name({5, 0, 0}) == "oak_fence[south=true,west=true]");
  CHECK(name({2, 0, -1}) == "oak_fence[south=true]");
  // The upper row has other neighbours.
  CHECK(name({0, 1, 0}) == "oak_fence[east=true]");
  CHECK(name({4, 1, 0}) == "oak_fence[west=true]");
  // The row is cleared, and what lies beside it parts.
  CHECK(fill({{1, 0, 0}, {5, 1, 1}}, "") == 4);
  CHECK(name(kHereVoxel) == "oak_fence[west=true]");
  CHECK(name({2, 0, -1}) == "oak_fence");
  CHECK(name({5, 0, 0}) == "oak_fence[south=true]");
}

TEST_CASE_METHOD(JoinBench, "a fill joins what its mask leaves alone", "[tools][hands]") {
  set({0, 0, 1}, "stone");
  set({0, 0, 2}, "minecraft:oak_fence");
  fill({{0, 0, 0}, {1, 1, 4}}, "minecraft:oak_fence", {MaskKind::only_empty, kEmpty});
  CHECK(voxels.at({0, 0, 1}) == id_in(table, "stone"));
  CHECK(name(kHereVoxel) == "oak_fence[south=true]");
  CHECK(name({0, 0, 2}) == "oak_fence[south=true]");  // towards the stone it stays as it was
  CHECK(name({0, 0, 3}) == "oak_fence[north=true]");
}

TEST_CASE_METHOD(JoinBench, "a straight filled wall has posts at its ends alone",
                 "[tools][hands]") {
  CHECK(fill({{-1, 0, 0}, {2, 1, 1}}, "minecraft:cobblestone_wall") == 1);
  CHECK(name(kWestVoxel) == "cobblestone_wall[east=low]");
  CHECK(name(kHereVoxel) == "cobblestone_wall[east=low,up=false,west=low]");
  CHECK(name(kEastVoxel) == "cobblestone_wall[west=low]");
}

TEST_CASE_METHOD(JoinBench, "boxes that are thick or large are filled as they are",
                 "[tools][hands]") {
  set({-1, 0, 0}, "minecraft:oak_fence");
  for (const VoxelBox& box : {VoxelBox{{0, 0, 0}, {2, 1, 2}}, VoxelBox{{0, 0, 0}, {129, 1, 1}},
                              VoxelBox{{0, 0, 0}, {1, 65, 64}}, VoxelBox{{0, 0, 0}, {0, 1, 1}}}) {
    const EditDescriptor whole{FillBox{box}, {}, id_in(table, "minecraft:oak_fence")};
    const auto reads = [&](VoxelPos pos) -> std::optional<Material> { return at(pos); };
    CHECK(joined_box(whole, table, reads) == ToolAction(std::vector{whole}));
  }
  // A line of another material changes its neighbours alone.
  CHECK(fill({{0, 0, 0}, {1, 1, 3}}, "stone") == 2);
  CHECK(name({-1, 0, 0}) == "oak_fence[east=true]");
  CHECK(at({0, 0, 2}) == id_in(table, "stone"));
}

TEST_CASE("the box tool and a filled selection join fences", "[tools][hands]") {
  ToolBench bench;
  bench.show_flat();
  const MaterialTable table = joins_table();
  static_cast<void>(bench.box.set_materials(table));
  const Material fence = id_in(table, "minecraft:oak_fence");
  REQUIRE(bench.box.choose("box"));
  const auto press = [&](VoxelPos at) {
    const auto made = bench.box.press(bench.replica, bench.aim_at(at, Direction::pos_y, fence),
                                      ToolButton::place);
    REQUIRE(made);
    bench.predict(*made);
  };
  press({3, -1, 3});
  press({6, -1, 3});
  CHECK(bench.at({3, 0, 3}) == id_in(table, "minecraft:oak_fence[east=true]"));
  CHECK(bench.at({5, 0, 3}) == id_in(table, "minecraft:oak_fence[east=true,west=true]"));
  bench.box.select(VoxelBox{{6, 0, 4}, {7, 1, 8}});
  const auto filled = bench.box.fill(bench.replica, fence);
  REQUIRE(filled);
  bench.predict(*filled);
  CHECK(bench.at({6, 0, 3}) == id_in(table, "minecraft:oak_fence[south=true,west=true]"));
  CHECK(bench.at({6, 0, 7}) == id_in(table, "minecraft:oak_fence[north=true]"));
  const auto replaced = bench.box.replace(bench.replica, fence, id_in(table, "stone"));
  REQUIRE(replaced);
  CHECK(replaced->edits.size() == 1);  // no voxel is a fence that joins nothing
  const auto cut = bench.box.cut(bench.replica, false);
  REQUIRE(cut);
  bench.predict(*cut);
  CHECK(bench.at({6, 0, 3}) == id_in(table, "minecraft:oak_fence[west=true]"));
}

TEST_CASE("the voxel tool joins fences, as edits that follow the first one", "[tools][hands]") {
  ToolBench bench;
  bench.show_flat();
  const MaterialTable table = joins_table();
  static_cast<void>(bench.box.set_materials(table));
  const Material fence = id_in(table, "minecraft:oak_fence");
  const auto press = [&](VoxelPos at, ToolButton button) {
    const auto made =
        bench.box.press(bench.replica, bench.aim_at(at, Direction::pos_y, fence), button);
    REQUIRE(made);
    bench.predict(*made);
    CHECK(made->has_followers == (made->edits.size() > 1));
    return made->edits.size();
  };
  CHECK(press({3, -1, 3}, ToolButton::place) == 1);
  CHECK(press({4, -1, 3}, ToolButton::place) == 2);
  CHECK(bench.at({3, 0, 3}) == id_in(table, "minecraft:oak_fence[east=true]"));
  CHECK(bench.at({4, 0, 3}) == id_in(table, "minecraft:oak_fence[west=true]"));
  CHECK(press({4, 0, 3}, ToolButton::clear) == 2);
  CHECK(bench.at({3, 0, 3}) == fence);
  // Copies change no neighbours.
  bench.box.set_symmetry({SymmetryKind::x, 0, 0});
  const auto made = bench.box.press(
      bench.replica, bench.aim_at({4, -1, 3}, Direction::pos_y, fence), ToolButton::place);
  REQUIRE(made);
  bench.predict(*made);
  CHECK(bench.at({3, 0, 3}) == fence);
  CHECK(bench.at({4, 0, 3}) == id_in(table, "minecraft:oak_fence[west=true]"));
  CHECK(bench.at({-4, 0, 3}) == id_in(table, "minecraft:oak_fence[east=true]"));
}

}  // namespace runstone::test
