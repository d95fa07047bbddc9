#include "client/tools/tool_box.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "client/tools/action_source.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

constexpr VoxelPos kGround{3, -1, 3};

struct FlatBench : ToolBench {
  FlatBench() { show_flat(); }
  /// Presses a button at the top of the ground, or at another voxel, and submits the edits.
  std::size_t press(VoxelPos voxel, ToolButton button = ToolButton::place, Material held = 2) {
    const auto edits = box.press(replica, aim_at(voxel, Direction::pos_y, held), button);
    REQUIRE(edits);
    predict(*edits);
    return edits->edits.size();
  }
  std::string refusal(VoxelPos voxel, ToolButton button) {
    const auto edits = box.press(replica, aim_at(voxel, Direction::pos_y), button);
    return edits ? "" : edits.error();
  }
};

}  // namespace

TEST_CASE_METHOD(FlatBench, "the voxel tool places against a face and removes the voxel itself",
                 "[tools]") {
  press(kGround);
  CHECK(at({3, 0, 3}) == 2);
  press({3, 0, 3}, ToolButton::clear);
  CHECK(at({3, 0, 3}) == kEmpty);
  CHECK(at(kGround) == 1);
}

TEST_CASE_METHOD(FlatBench, "a box has two corners, and the other button forgets the first one",
                 "[tools]") {
  REQUIRE(box.choose("box"));
  CHECK(press(kGround) == 0);
  CHECK(box.points().size() == 1);
  CHECK(press({5, -1, 5}, ToolButton::clear) == 0);
  CHECK(box.points().empty());
  press(kGround);
  CHECK(press({5, -1, 6}) == 1);
  for (VoxelPos p{3, 0, 3}; p.x <= 5; ++p.x) {
    for (p.z = 3; p.z <= 6; ++p.z) CHECK(at(p) == 2);
  }
  CHECK(at({6, 0, 3}) == kEmpty);
  press({3, -2, 3}, ToolButton::clear);
  press({3, -1, 3}, ToolButton::clear);
  CHECK(at({3, -2, 3}) == kEmpty);
}

TEST_CASE_METHOD(FlatBench, "the box tool fills a box, its shell, or its walls", "[tools]") {
  const VoxelBox around{{-6, 0, -6}, {7, 9, 7}};
  for (const std::int32_t fill : {0, 1, 2}) {
    for (const std::int32_t wall : {1, 2, 4}) {
      CAPTURE(fill, wall);
      REQUIRE(box.choose("box"));
      REQUIRE(box.set_parameter("fill", fill));
      REQUIRE(box.set_parameter("wall", wall));
      const VoxelBox target{{-4, 1, -5}, {4, 8, 6}};
      box.type_places(TypedPlaces{ToolButton::place, {target.min, {3, 7, 5}}, Direction::pos_y});
      const auto made = box.apply_typed(replica, 2);
      REQUIRE(made);
      predict(*made);
      std::size_t wrong = 0;
      for (VoxelPos v = around.min; v.z < around.max.z; ++v.z) {
        for (v.y = around.min.y; v.y < around.max.y; ++v.y) {
          for (v.x = around.min.x; v.x < around.max.x; ++v.x) {
            const auto depth = [](std::int32_t at, std::int32_t low, std::int32_t high) {
              return std::min(at - low, high - 1 - at);
            };
            const std::int32_t beside = std::min(depth(v.x, target.min.x, target.max.x),
                                                 depth(v.z, target.min.z, target.max.z));
            const std::int32_t upright = depth(v.y, target.min.y, target.max.y);
            const bool is_shell = beside < wall || (fill == 1 && upright < wall);
            const bool is_set = target.contains(v) && (fill == 0 || is_shell);
            wrong += at(v) != (is_set ? Material{2} : kEmpty) ? 1 : 0;
          }
        }
      }
      CHECK(wrong == 0);
      predict(std::vector{EditDescriptor{FillBox{around}, {}, kEmpty}});
    }
  }
}

TEST_CASE_METHOD(FlatBench, "the second corner may lie in the air, as far away as the first one",
                 "[tools]") {
  REQUIRE(box.choose("box"));
  Aim aim = aim_at(kGround, Direction::pos_y);  // the eye is 4.5 voxels above the place (3, 0, 3)
  REQUIRE(box.press(replica, aim, ToolButton::place));
  aim.hit.reset();
  aim.look = {1, 0, 0};
  const auto edits = box.press(replica, aim, ToolButton::place);
  REQUIRE(edits);
  CHECK(edits->edits.front() ==
        EditDescriptor{FillBox{box_between({3, 0, 3}, voxel_on_ray(aim, 4))}, {}, 2});
  CHECK(box.press(replica, aim, ToolButton::place).error() == "nothing is in reach");
}

TEST_CASE_METHOD(FlatBench, "a sphere has a typed radius, or a dragged one if that is 0",
                 "[tools]") {
  REQUIRE(box.choose("sphere"));
  const auto typed = box.press(replica, aim_at(kGround, Direction::pos_y), ToolButton::clear);
  REQUIRE(typed);
  CHECK(typed->edits.front() == EditDescriptor{FillSphere{kGround, 4}, {}, kEmpty});
  REQUIRE(box.set_parameter("radius", 0));
  CHECK(press(kGround) == 0);
  const auto dragged = box.press(replica, aim_at({6, -1, 7}, Direction::pos_y), ToolButton::place);
  REQUIRE(dragged);
  CHECK(dragged->edits.front() == EditDescriptor{FillSphere{{3, 0, 3}, 5}, {}, 2});
}

TEST_CASE_METHOD(FlatBench, "a stroke is one edit along the places of the held button", "[tools]") {
  REQUIRE(box.choose("stroke"));
  CHECK(press(kGround) == 0);
  box.drag(aim_at({5, -1, 3}, Direction::pos_y));
  box.drag(aim_at({5, -1, 3}, Direction::pos_y));  // the same place counts once
  const auto edits = box.release(replica, aim_at({5, -1, 8}, Direction::pos_y));
  REQUIRE(edits);
  REQUIRE(edits->edits.size() == 1);
  CHECK(edits->edits.front() ==
        EditDescriptor{FillStroke{{{3, 0, 3}, {5, 0, 3}, {5, 0, 8}}, 2}, {}, 2});
  CHECK(box.release(replica, aim_at(kGround, Direction::pos_y))->empty());
}

TEST_CASE_METHOD(FlatBench, "fill changes the connected surface of one material, up to its bound",
                 "[tools]") {
  predict({{FillBox{{{0, -1, 0}, {8, 0, 8}}}, {}, 3}});  // a square of another material
  predict({{FillBox{{{4, 0, 0}, {8, 1, 8}}}, {}, 3}});   // its half is one voxel higher
  REQUIRE(box.choose("fill"));
  CHECK(press({1, -1, 1}) == 1);
  CHECK(at({0, -1, 7}) == 2);
  CHECK(at({7, 0, 7}) == 2);   // the surface follows the step
  CHECK(at({7, -1, 7}) == 3);  // below it
  CHECK(at({8, -1, 8}) == 1);  // another material
  REQUIRE(box.set_parameter("voxels", 5));
  press({12, -1, 12});
  CHECK(at({12, -1, 12}) == 2);
  CHECK(at({13, -1, 12}) == 2);
  CHECK(at({14, -1, 12}) == 1);
}

TEST_CASE_METHOD(FlatBench, "a costly tool is previewed when the aim rests", "[tools]") {
  predict({{FillBox{{{-4, -3, -4}, {5, 0, 5}}}, {}, kEmpty}});
  box.set_materials(default_material_table());
  REQUIRE(box.choose("flood"));
  REQUIRE(box.set_parameter("depth", 2));
  const auto step = [&](VoxelPos voxel, unsigned calls) {
    for (unsigned i = 0; i < calls; ++i)
      static_cast<void>(box.step_preview(replica, aim_at(voxel, Direction::pos_y), 64));
  };
  step({0, -4, 0}, ToolBox::kRestCalls);
  step({1, -4, 0}, ToolBox::kRestCalls);
  CHECK(box.preview().edits().empty());
  step({1, -4, 0}, 1);
  REQUIRE(box.preview().edits().size() == 1);
  CHECK_FALSE(box.ghosts().empty());
  step({2, -4, 0}, 1);
  CHECK(box.preview().edits().empty());
  CHECK(box.ghosts().empty());
  CHECK_FALSE(box.is_preview_complete());
  // A picture does not wait for a resting aim.
  static_cast<void>(box.step_preview(replica, aim_at({2, -4, 0}, Direction::pos_y),
                                     std::numeric_limits<std::size_t>::max()));
  CHECK(box.preview().edits().size() == 1);
  CHECK(box.is_preview_complete());
  // A refusal stands until the ground changes.
  step({0, -1, 20}, ToolBox::kRestCalls + 1);
  CHECK(box.preview_refusal() == "the hollow reaches ground that is not loaded");
  predict({{FillBox{{{-1, 0, 18}, {2, 2, 23}}}, {}, 1},
           {FillBox{{{0, 0, 20}, {1, 2, 21}}}, {}, kEmpty}});
  step({0, -1, 20}, 300 + ToolBox::kRestCalls);
  CHECK(box.preview_refusal().empty());
  CHECK(box.preview().placed_voxels() == 2);
}

TEST_CASE_METHOD(FlatBench, "flood fills a hollow up to a level, with all of it as one action",
                 "[tools]") {
  // A pit of 9 x 5 x 9 voxels over four chunks, with a pillar, and a pond of another material.
  predict({{FillBox{{{-4, -5, -4}, {5, 0, 5}}}, {}, kEmpty},
           {FillBox{{{0, -5, 0}, {1, 0, 1}}}, {}, 1},
           {FillBox{{{-4, -5, -4}, {5, -4, -3}}}, {}, 3}});
  MaterialTable table;
  for (const char* name : {"stone", "water", "swamp"}) {
    MaterialInfo row;
    row.name = name;
    if (row.name != "stone") row.body = MaterialBody::liquid;
    REQUIRE(table.add(std::move(row)));
  }
  box.set_materials(table);
  REQUIRE(box.choose("flood"));
  REQUIRE(box.set_parameter("depth", 3));
  const auto made = box.press(replica, aim_at({2, -6, 2}, Direction::pos_y), ToolButton::place);
  REQUIRE(made);
  CHECK(is_small(*made, replica.edit_limits()));
  REQUIRE(made->edits.size() == 1);
  CHECK(made->edits.front().mask == Mask{MaskKind::only_empty, kEmpty});
  predict(*made);
  CHECK(at({-4, -5, 4}) == 2);
  CHECK(at({4, -3, 4}) == 2);
  CHECK(at({4, -2, 4}) == kEmpty);  // above the level
  CHECK(at({0, -4, 0}) == 1);       // the pillar
  CHECK(at({-4, -5, -4}) == 3);     // the pond
  CHECK(at({-4, -4, -4}) == 2);     // over it
  CHECK(refusal({2, -6, 2}, ToolButton::clear) == "flood with the right button");
  // The level of a second click.
  REQUIRE(box.set_parameter("depth", 0));
  CHECK(press({2, -4, 2}) == 0);
  CHECK(press({7, -2, 7}) == 1);
  CHECK(at({4, -1, 4}) == 2);
  CHECK(at({5, 0, 5}) == kEmpty);
  // Over the rim it would flood the world.
  REQUIRE(box.set_parameter("depth", 1));
  REQUIRE(box.set_parameter("voxels", 500));
  CHECK(
      refusal({7, -1, 7}, ToolButton::place) ==
      "up to that level the hollow has more than 500 voxels: it may be open to a side, or needs a "
      "higher limit");
  REQUIRE(box.set_parameter("voxels", 1'000'000));
  CHECK(refusal({7, -1, 7}, ToolButton::place) == "the hollow reaches ground that is not loaded");
}

TEST_CASE_METHOD(FlatBench, "replace changes one material in a sphere, a cube or the selection",
                 "[tools]") {
  predict({{FillBox{{{0, -3, 0}, {8, 0, 8}}}, {}, 3}});
  REQUIRE(box.choose("replace"));
  REQUIRE(box.set_parameter("where", 1));
  REQUIRE(box.set_parameter("radius", 2));
  press({7, -1, 7});
  CHECK(at({5, -3, 5}) == 2);
  CHECK(at({8, -1, 8}) == 1);
  CHECK(at({7, 0, 7}) == kEmpty);
  REQUIRE(box.set_parameter("where", 2));
  CHECK(refusal({0, -1, 0}, ToolButton::place) == "nothing is selected");
  box.select(VoxelBox{{0, -1, 0}, {1, 0, 8}});
  press({0, -1, 0}, ToolButton::clear);
  CHECK(at({0, -1, 7}) == kEmpty);
  CHECK(at({1, -1, 7}) == 3);
  CHECK(refusal({5, -3, 5}, ToolButton::place) == "you hold the material that you look at");
}

TEST_CASE_METHOD(FlatBench, "paint changes the surface in a sphere and keeps air", "[tools]") {
  REQUIRE(box.choose("paint"));
  press(kGround);
  CHECK(at(kGround) == 2);
  CHECK(at({6, -1, 3}) == 2);
  CHECK(at({3, -2, 3}) == 1);  // it has no face
  CHECK(at({3, 0, 3}) == kEmpty);
  CHECK(refusal(kGround, ToolButton::place) == "there is nothing to change here");
  CHECK(refusal(kGround, ToolButton::clear) == "paint with the right button");
}

TEST_CASE_METHOD(FlatBench, "extrude pushes a flat face out and in by its depth", "[tools]") {
  predict({{FillBox{{{0, 0, 0}, {3, 1, 2}}}, {}, 3}});
  REQUIRE(box.choose("extrude"));
  REQUIRE(box.set_parameter("depth", 4));
  press({1, 0, 1});
  CHECK(at({2, 4, 1}) == 3);
  CHECK(at({2, 5, 1}) == kEmpty);
  CHECK(at({3, 1, 1}) == kEmpty);
  press({1, 4, 1}, ToolButton::clear);
  CHECK(at({0, 1, 0}) == kEmpty);
  CHECK(at({0, 0, 0}) == 3);
  REQUIRE(box.set_parameter("depth", 64));
  REQUIRE(box.set_parameter("voxels", 16384));
  CHECK(refusal({20, -1, 20}, ToolButton::place) == "the change has more than 65,536 voxels");
}

TEST_CASE_METHOD(FlatBench, "a selection is copied, cut, pasted, turned, stacked and moved",
                 "[tools]") {
  predict({{SetVoxel{{0, 0, 0}}, {}, 2}, {SetVoxel{{2, 0, 0}}, {}, 3}});
  CHECK(box.copy(replica, true).error() == "nothing is selected");
  REQUIRE(box.choose("select"));
  press({0, 0, 0});
  press({2, 0, 0});
  REQUIRE(box.selection() == VoxelBox{{0, 0, 0}, {3, 1, 1}});
  const auto cut = box.cut(replica, true);
  REQUIRE(cut);
  predict(*cut);
  CHECK(at({0, 0, 0}) == kEmpty);

  REQUIRE(box.choose("paste"));
  press({10, -1, 10});
  CHECK(at({9, 0, 10}) == 2);
  CHECK(at({11, 0, 10}) == 3);
  REQUIRE(box.rotate(1));  // +x turns to -z
  press({10, -1, 5});
  CHECK(at({10, 0, 6}) == 2);
  CHECK(at({10, 0, 4}) == 3);
  REQUIRE(box.mirror(Axis::z));
  press({-10, -1, 5});
  CHECK(at({-10, 0, 4}) == 2);

  box.select(VoxelBox{{9, 0, 10}, {12, 1, 11}});
  const auto stack = box.stack(replica, Direction::pos_y, 3);
  REQUIRE(stack);
  CHECK(stack->edits.size() == 1);  // one record
  predict(*stack);
  CHECK(at({9, 3, 10}) == 2);
  const auto moved_voxels = box.move(replica, Direction::pos_z, 2);
  REQUIRE(moved_voxels);
  CHECK(moved_voxels->edits.size() == 1);
  predict(*moved_voxels);
  CHECK(at({9, 0, 10}) == kEmpty);
  CHECK(at({9, 0, 12}) == 2);
  CHECK(box.selection() == VoxelBox{{9, 0, 12}, {12, 1, 13}});
  const auto filled = box.fill(replica, 1);
  REQUIRE(filled);
  predict(*filled);
  CHECK(at({10, 0, 12}) == 1);
  CHECK(box.stack(replica, Direction::pos_y, 4097).error() == "a stack has 1 to 4096 copies");
}

TEST_CASE_METHOD(FlatBench, "a selection that moves onto a part of itself keeps its gaps",
                 "[tools]") {
  const auto row = [this](std::vector<Material> voxels) {
    for (std::size_t i = 0; i < voxels.size(); ++i)
      CHECK(at({static_cast<std::int32_t>(i), 0, 0}) == voxels[i]);
  };
  predict(
      {{SetVoxel{{1, 0, 0}}, {}, 2}, {SetVoxel{{3, 0, 0}}, {}, 3}, {SetVoxel{{6, 0, 0}}, {}, 1}});
  box.select(VoxelBox{{1, 0, 0}, {5, 1, 1}});
  predict(*box.move(replica, Direction::pos_x, 2));
  row({0, 0, 0, 2, 0, 3, 1});  // where the selection has air, the world stays
  predict(*box.move(replica, Direction::neg_x, 1));
  row({0, 0, 2, 0, 3, 1, 0});
  CHECK(box.selection() == VoxelBox{{2, 0, 0}, {6, 1, 1}});
  CHECK(box.move(replica, Direction::pos_x, 0).error() ==
        "the selection moves by one voxel or more");
  box.select(VoxelBox{{20, 3, 0}, {22, 4, 1}});
  CHECK(box.move(replica, Direction::pos_y, 1).error() == "the selection is empty");
}

TEST_CASE_METHOD(FlatBench, "a selection grows, shrinks to one voxel at least, and shifts",
                 "[tools]") {
  CHECK(box.grow(Direction::pos_x, 1).error() == "nothing is selected");
  box.select(VoxelBox{{0, 0, 0}, {3, 1, 1}});
  REQUIRE(box.grow(Direction::pos_x, 2));
  REQUIRE(box.grow(Direction::neg_y, 1));
  CHECK(box.selection() == VoxelBox{{0, -1, 0}, {5, 1, 1}});
  REQUIRE(box.grow(Direction::neg_x, -50));
  CHECK(box.selection() == VoxelBox{{4, -1, 0}, {5, 1, 1}});
  REQUIRE(box.shift(Direction::neg_z, 3));
  CHECK(box.selection() == VoxelBox{{4, -1, -3}, {5, 1, -2}});
  box.select(VoxelBox{});
  CHECK_FALSE(box.selection());
}

TEST_CASE_METHOD(FlatBench, "the clipboard keeps its materials by name from world to world",
                 "[tools]") {
  const auto table = [](std::vector<std::string> names) {
    MaterialTable out;
    for (std::string& name : names) {
      MaterialInfo info;
      info.name = std::move(name);
      REQUIRE(out.add(std::move(info)));
    }
    return out;
  };
  CHECK(box.set_materials(table({"stone", "sand", "ice"})).empty());
  predict({{SetVoxel{{0, 0, 0}}, {}, 2}, {SetVoxel{{2, 0, 0}}, {}, 3}});
  box.select(VoxelBox{{0, 0, 0}, {3, 1, 1}});
  REQUIRE(box.copy(replica, true));
  CHECK(box.set_materials(table({"clay", "stone", "sand", "ice"})).empty());
  CHECK(box.clipboard().whole->palette() == std::vector<Material>{3, 4});
  CHECK(box.set_materials(table({"sand"})) ==
        "the nearest colours take the place of materials that this world lacks: ice");
  CHECK(box.clipboard().whole->palette() == std::vector<Material>{1});
  CHECK(box.clipboard().build->solid() == 2);
  CHECK(box.set_materials(table({"clay"})) ==
        "the nearest colours take the place of materials that this world lacks: sand");
  CHECK(box.clipboard().build->solid() == 2);
  REQUIRE(box.clipboard_rows().size() == 2);  // air, too
  CHECK((box.clipboard_rows()[0].name == "clay" || box.clipboard_rows()[1].name == "clay"));
}

namespace {

/// A replica with ground that no descriptor can hold: 64 voxels a side, in 64 chunks.
struct RichBench : ToolBench {
  RichBench() {
    for (std::int32_t x = -2; x < 2; ++x) {
      for (std::int32_t y = -2; y < 2; ++y) {
        for (std::int32_t z = -2; z < 2; ++z) {
          RunBuilder voxels(Extent::cube(kEdge), AxisOrder::xyz);
          for (int i = 0; i < kEdge * kEdge * kEdge; ++i)
            voxels.append(1, static_cast<Material>(rng.between(0, 3)));
          show({x, y, z}, voxels.finish());
        }
      }
    }
    box.select(kAll);
  }
  static constexpr VoxelBox kAll{{-32, -32, -32}, {32, 32, 32}};

  std::vector<Material> voxels() const {
    std::vector<Material> out;
    for (VoxelPos p{-32, -32, -32}; p.z < 32; ++p.z) {
      for (p.y = -32; p.y < 32; ++p.y) {
        for (p.x = -32; p.x < 32; ++p.x) out.push_back(at(p));
      }
    }
    return out;
  }
  static std::size_t slot(VoxelPos p) {
    return static_cast<std::size_t>(p.x + 32 + 64 * (p.y + 32 + 64 * (p.z + 32)));
  }
};

}  // namespace

TEST_CASE_METHOD(RichBench, "a selection that no descriptor holds is copied, turned and pasted",
                 "[tools]") {
  const std::uint64_t dense = dense_expansions();
  REQUIRE(box.copy(replica, false));
  CHECK(box.clipboard().whole == nullptr);
  CHECK(box.clipboard().build->volume() == 64 * 64 * 64);
  const std::vector<Material> before = voxels();
  REQUIRE(box.rotate(1));
  REQUIRE(box.choose("paste"));
  const auto made = box.press(replica, aim_at({0, -33, 0}, Direction::pos_y), ToolButton::place);
  REQUIRE(made);
  CHECK(made->edits.empty());
  REQUIRE(made->pastes.size() == 1);
  CHECK_FALSE(is_small(*made, replica.edit_limits()));
  predict(*made);
  const std::vector<Material> after = voxels();
  std::size_t wrong = 0;
  for (VoxelPos p{-32, -32, -32}; p.z < 32; ++p.z) {
    for (p.y = -32; p.y < 32; ++p.y) {
      // A quarter turn takes +z to +x and +x to -z.
      for (p.x = -32; p.x < 32; ++p.x)
        wrong += after[slot({p.z, p.y, -1 - p.x})] != before[slot(p)];
    }
  }
  CHECK(wrong == 0);
  CHECK(dense_expansions() == dense);
}

TEST_CASE_METHOD(RichBench, "a large selection moves by pastes, and is cleared after all of them",
                 "[tools]") {
  box.select(VoxelBox{{-32, -32, -32}, {30, 32, 32}});
  const std::vector<Material> before = voxels();
  const auto made = box.move(replica, Direction::pos_x, 2);
  REQUIRE(made);
  CHECK(made->pastes.size() + made->edits.size() == 3);
  CHECK(made->pastes.back().empty == EmptyCells::pasted);
  REQUIRE(made->edits.back() ==
          EditDescriptor{FillBox{{{-32, -32, -32}, {-30, 32, 32}}}, {}, kEmpty});
  const auto source = source_of(*made, replica.edit_limits());
  std::vector<SourceStep::Kind> kinds;
  for (SourceStep step = source->next(); step.kind != SourceStep::Kind::end;
       step = source->next()) {
    if (kinds.empty() || kinds.back() != step.kind) kinds.push_back(step.kind);
  }
  using Kind = SourceStep::Kind;
  CHECK(kinds == std::vector<Kind>{Kind::edit, Kind::barrier, Kind::edit});
  predict(*made);
  std::size_t wrong = 0;
  for (VoxelPos p{-32, -32, -32}; p.z < 32; ++p.z) {
    for (p.y = -32; p.y < 32; ++p.y) {
      for (p.x = -32; p.x < 28; ++p.x) wrong += at({p.x + 2, p.y, p.z}) != before[slot(p)];
    }
  }
  CHECK(wrong == 0);
  CHECK(at({-31, 0, 0}) == kEmpty);
}

TEST_CASE_METHOD(RichBench, "symmetry mirrors a large paste, and a stack of it shares its sections",
                 "[tools]") {
  REQUIRE(box.copy(replica, true));
  REQUIRE(box.choose("paste"));
  box.set_symmetry({SymmetryKind::x, 201, 0});
  const auto made = box.press(replica, aim_at({0, 40, 0}, Direction::pos_y), ToolButton::place);
  REQUIRE(made);
  REQUIRE(made->pastes.size() == 2);
  CHECK(made->pastes[0].at == VoxelPos{-32, 41, -32});
  CHECK(made->pastes[1].at == VoxelPos{201 - 31, 41, -32});
  for (const std::int32_t x : {0, 13, 63})
    CHECK(made->pastes[0].build->at({x, 5, 9}) == made->pastes[1].build->at({63 - x, 5, 9}));
  const auto again = box.press(replica, aim_at({0, 40, 0}, Direction::pos_y), ToolButton::place);
  CHECK(again->pastes[1].build == made->pastes[1].build);  // it is mirrored once
  const auto stack = box.stack(replica, Direction::neg_y, 100);
  REQUIRE(stack);
  REQUIRE(stack->pastes.size() == 1);
  CHECK(stack->pastes[0].box() == VoxelBox{{-32, -32 - 6400, -32}, {32, -32, 32}});
  CHECK(stack->pastes[0].build->distinct_sections().size() == 64);
}

TEST_CASE_METHOD(RichBench, "a large paste is previewed by coarse cells within the bound of quads",
                 "[tools]") {
  static_cast<void>(box.set_materials(default_material_table()));
  REQUIRE(box.copy(replica, false));
  REQUIRE(box.choose("paste"));
  const std::uint64_t dense = dense_expansions();
  // Returns the turns after the first one.
  const auto finish = [&](VoxelPos voxel) {
    const Aim aim = aim_at(voxel, Direction::pos_y);
    int turns = 0;
    static_cast<void>(box.step_preview(replica, aim, 4));
    while (!box.preview().is_complete() || !box.build_preview().is_complete()) {
      REQUIRE(++turns < 1000);
      static_cast<void>(box.step_preview(replica, aim, 4));
    }
    return turns;
  };
  CHECK(finish({0, -33, 0}) > 0);
  const std::int32_t cell = box.build_preview().cell_voxels();
  CHECK(cell > 1);  // three of four voxels are set: too many faces at full detail
  std::size_t quads = 0;
  for (const GhostChunk& ghost : box.ghosts()) {
    CHECK(ghost.shift == VoxelPos{-32, -32, -32});
    CHECK(ghost.edge == 64 * cell);
    CHECK(1 << ghost.key.lod == cell);
    quads += ghost.placed->quad_count();
  }
  CHECK(quads > 100);
  CHECK(quads <= BuildPreview::kQuadsMax);
  CHECK(box.build_preview().placed_voxels() == box.clipboard().build->solid());
  const auto mesh = box.ghosts().front().placed;
  CHECK(finish({5, 7, -3}) == 0);  // a moved paste keeps its meshes
  CHECK(box.ghosts().front().placed == mesh);
  CHECK(box.ghosts().front().shift == VoxelPos{-27, 8, -35});
  CHECK(dense_expansions() == dense);
}

TEST_CASE_METHOD(FlatBench, "parameters have ranges, and steps stay inside them", "[tools]") {
  CHECK(box.choose("saw").error() == "there is no tool saw");
  REQUIRE(box.choose("stroke"));
  CHECK(box.set_parameter("radius", 0).error() == "radius must be from 1 to 32");
  CHECK(box.set_parameter("colour", 0).error() == "the tool stroke has no parameter colour");
  box.change_size(-9);
  CHECK(box.tool().parameters()[0].value == 1);
  box.change_size(3);
  CHECK(box.tool().parameters()[0].value == 4);
}

}  // namespace runstone::test
