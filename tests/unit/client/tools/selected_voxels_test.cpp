#include "client/tools/selected_voxels.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "client/tools/action_source.hpp"
#include "client/tools/tool_command.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/materials/material_table.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

using ChosenVoxels = std::set<VoxelPos>;

/// The voxels that the tests look at lie from -kSeen to kSeen - 1 along each axis.
constexpr std::int32_t kSeen = 14;

template <class F>
void for_each_seen(F&& f) {
  for (VoxelPos v{-kSeen, -kSeen, -kSeen}; v.z < kSeen; ++v.z) {
    for (v.y = -kSeen; v.y < kSeen; ++v.y) {
      for (v.x = -kSeen; v.x < kSeen; ++v.x) f(v);
    }
  }
}

/// Random ground of the materials 0 .. 3, whose names are air, grass, dirt and stone.
struct VoxelsBench : ToolBench {
  VoxelsBench() {
    show_random();
    box.set_materials(default_material_table());
    for (Material m = 1; m < 4; ++m) name[m] = default_material_table()[m].name;
  }
  ChosenVoxels selected() const {
    ChosenVoxels out;
    for_each_seen([&](VoxelPos v) {
      const Selected& now = box.selected();
      if (now.voxels ? now.voxels->contains(v) : now.boxes.contains(v)) out.insert(v);
    });
    return out;
  }
  std::map<VoxelPos, Material> world() const {
    std::map<VoxelPos, Material> out;
    for_each_seen([&](VoxelPos v) { out[v] = at(v); });
    return out;
  }
  /// Carries out a command of the selection, and sends its edits in their order.
  bool run(SelectionCommand command) {
    const auto made = carry_out(box, replica, 2, command);
    if (!made) return false;
    predict(*made);
    if (made->cleared) {
      ToolAction last;
      last.pastes.push_back(*made->cleared);
      predict(last);
    }
    return true;
  }
  bool narrow(SelectionCommand::Kind kind, std::string filter) {
    SelectionCommand command;
    command.kind = kind;
    command.filter = std::move(filter);
    return run(command);
  }
  std::array<std::string, 4> name;
};

constexpr VoxelBox kChosen{{-7, -6, -5}, {6, 7, 8}};

}  // namespace

TEST_CASE_METHOD(VoxelsBench, "voxels are selected by material, added, left out and grown",
                 "[tools][property]") {
  using Kind = SelectionCommand::Kind;
  box.select(kChosen);
  ChosenVoxels wanted = selected();
  REQUIRE(narrow(Kind::keep, "is " + name[1] + " or " + name[2]));
  std::erase_if(wanted, [&](VoxelPos v) { return at(v) != 1 && at(v) != 2; });
  REQUIRE_FALSE(wanted.empty());
  CHECK(selected() == wanted);
  CHECK_FALSE(box.selected_box());

  REQUIRE(narrow(Kind::drop, "is " + name[2]));
  std::erase_if(wanted, [&](VoxelPos v) { return at(v) == 2; });
  CHECK(selected() == wanted);

  REQUIRE(box.select({{0, 0, 0}, {3, 4, 5}}, SelectMode::add));
  REQUIRE(box.select({{-20, -2, -20}, {20, 1, 20}}, SelectMode::remove));
  for_each_seen([&](VoxelPos v) {
    if (VoxelBox{{0, 0, 0}, {3, 4, 5}}.contains(v)) wanted.insert(v);
    if (v.y >= -2 && v.y < 1) wanted.erase(v);
  });
  CHECK(selected() == wanted);

  SelectionCommand grow;
  grow.kind = Kind::grow;
  grow.direction = Direction::neg_z;
  grow.count = 2;
  REQUIRE(run(grow));
  const ChosenVoxels before = wanted;
  for (const VoxelPos v : before) {
    wanted.insert({v.x, v.y, v.z - 1});
    wanted.insert({v.x, v.y, v.z - 2});
  }
  CHECK(selected() == wanted);

  CHECK_FALSE(narrow(Kind::keep, "is " + name[1] + " and not is " + name[1]));
  CHECK(selected() == wanted);
  const auto wrong = carry_out(box, replica, 2, SelectionCommand{Kind::keep});
  REQUIRE_FALSE(wrong);
  CHECK(wrong.error() == "type which voxels, such as: is stone and exposed");
}

TEST_CASE_METHOD(VoxelsBench, "the commands of a selection change exactly its single voxels",
                 "[tools][property]") {
  using Kind = SelectionCommand::Kind;
  const int what = GENERATE(0, 1, 2, 3, 4);
  CAPTURE(what);
  box.select(kChosen);
  REQUIRE(narrow(Kind::keep, "is " + name[1] + " or not exposed"));
  const ChosenVoxels chosen = selected();
  const std::map<VoxelPos, Material> before = world();
  std::map<VoxelPos, Material> wanted = before;
  SelectionCommand command;
  switch (what) {
    case 0:
      command.kind = Kind::fill;
      command.material = 3;
      for (const VoxelPos v : chosen) wanted[v] = 3;
      break;
    case 1:
      command.kind = Kind::replace;
      command.material = 1;
      command.other = 3;
      for (const VoxelPos v : chosen) {
        if (wanted[v] == 1) wanted[v] = 3;
      }
      break;
    case 2:
      command.kind = Kind::cut;
      for (const VoxelPos v : chosen) wanted[v] = kEmpty;
      break;
    default:
      command.kind = Kind::move;
      command.direction = what == 3 ? Direction::pos_x : Direction::neg_y;
      command.count = 2;
      for (const VoxelPos v : chosen) {
        if (!chosen.contains(moved(v, command.direction, -2))) wanted[v] = kEmpty;
      }
      for (const VoxelPos v : chosen) {
        const VoxelPos to = moved(v, command.direction, 2);
        if (before.at(v) != kEmpty || chosen.contains(to)) wanted[to] = before.at(v);
      }
      break;
  }
  REQUIRE(run(command));
  CHECK(world() == wanted);
  if (what == 2) {
    const VoxelBox around = *box.selection();
    std::size_t wrong = 0;
    for_each_seen([&](VoxelPos v) {
      if (!around.contains(v)) return;
      const auto cell =
          box.clipboard().build->at({v.x - around.min.x, v.y - around.min.y, v.z - around.min.z});
      wrong += cell != (chosen.contains(v) ? std::optional(before.at(v)) : std::nullopt) ? 1 : 0;
    });
    CHECK(wrong == 0);
  }
  if (what > 2) {
    ChosenVoxels moved_there;
    for (const VoxelPos v : chosen) moved_there.insert(moved(v, command.direction, 2));
    CHECK(selected() == moved_there);
  }
}

TEST_CASE_METHOD(VoxelsBench, "the place that single voxels leave is cleared after all was placed",
                 "[tools]") {
  box.select(kChosen);
  REQUIRE(narrow(SelectionCommand::Kind::keep, "is " + name[1]));
  const auto made = box.move(replica, Direction::pos_x, 2);
  REQUIRE(made);
  REQUIRE(made->cleared);
  CHECK_FALSE(is_small(*made, replica.edit_limits()));
  CHECK(clears_at_end(*made));
  const auto source = source_of(*made, replica.edit_limits());
  std::uint64_t before = 0, behind = 0;
  int barriers = 0;
  for (SourceStep step = source->next(); step.kind != SourceStep::Kind::end;
       step = source->next()) {
    if (step.kind == SourceStep::Kind::barrier) {
      ++barriers;
    } else {
      REQUIRE(step.kind == SourceStep::Kind::edit);
      (barriers == 0 ? before : behind) += counted_voxels(step.edit);
    }
  }
  CHECK(barriers == 1);
  CHECK(before > 0);
  CHECK(behind == made->cleared->build->touched());
}

TEST_CASE_METHOD(VoxelsBench, "the tools that work in the selection change its single voxels",
                 "[tools]") {
  using Kind = SelectionCommand::Kind;
  box.select(kChosen);
  REQUIRE(narrow(Kind::keep, "is " + name[1]));
  const ChosenVoxels chosen = selected();
  std::map<VoxelPos, Material> wanted = world();
  for (const VoxelPos v : chosen) wanted[v] = 3;
  REQUIRE(box.choose("mix"));
  REQUIRE(box.set_parameter("region", 1));
  REQUIRE(box.set_text("pattern", name[3]));
  const auto made =
      box.press(replica, aim_at(*chosen.begin(), Direction::pos_y), ToolButton::place);
  REQUIRE(made);
  REQUIRE(made->pattern);
  const auto source = source_of(*made, replica.edit_limits());
  for (SourceStep step = source->next(); step.kind != SourceStep::Kind::end; step = source->next())
    if (step.kind == SourceStep::Kind::edit) predict(std::vector{step.edit});
  CHECK(world() == wanted);
  REQUIRE(box.choose("replace"));
  REQUIRE(box.set_parameter("where", 2));
  const auto again =
      box.press(replica, aim_at(*chosen.begin(), Direction::pos_y, 2), ToolButton::place);
  REQUIRE(again);
  predict(*again);
  for (const VoxelPos v : chosen) wanted[v] = 2;
  CHECK(world() == wanted);
}

TEST_CASE_METHOD(ToolBench, "the wand selects connected voxels, adds some and takes some away",
                 "[tools]") {
  show_flat();
  box.set_materials(default_material_table());
  predict(std::vector{EditDescriptor{FillBox{{{0, 0, 0}, {3, 2, 1}}}, {}, 2},
                      EditDescriptor{FillBox{{{6, 0, 0}, {8, 1, 1}}}, {}, 2}});
  REQUIRE(box.choose("wand"));
  const auto click = [&](VoxelPos at, std::int32_t result, ToolButton button = ToolButton::place) {
    REQUIRE(box.set_parameter("result", result));
    const auto made = box.press(replica, aim_at(at, Direction::pos_y), button);
    REQUIRE(made);
    CHECK(made->empty());
    const Selected& now = box.selected();
    CHECK(now.voxel_count == (now.voxels ? now.voxels->count() : 0));
    return now.voxel_count;
  };
  CHECK(click({1, 1, 0}, 1) == 6);
  CHECK_FALSE(box.clipboard().build);
  CHECK(click({7, 0, 0}, 2) == 8);
  CHECK(click({0, 0, 0}, 3) == 2);
  CHECK(click({0, 0, 0}, 1) == 6);
  CHECK(click({7, 0, 0}, 1, ToolButton::clear) == 6);
  // A held key counts instead of the parameter.
  box.hold_select_mode(SelectMode::add);
  CHECK(click({7, 0, 0}, 1) == 8);
  box.hold_select_mode(std::nullopt);
  REQUIRE(box.fill(replica, 3));
  predict(*box.fill(replica, 3));
  CHECK(at({2, 1, 0}) == 3);
  CHECK(at({7, 0, 0}) == 3);
  CHECK(at({2, 2, 0}) == kEmpty);
  CHECK(box.fill(replica, 3).error() == "no selected voxel would change");
}

TEST_CASE_METHOD(ToolBench, "a selection of too many single voxels is refused in words",
                 "[tools]") {
  show_flat();
  box.set_materials(default_material_table());
  box.select(VoxelBox{{-500, -500, -500}, {500, 500, 500}});
  CHECK(box.narrow(replica, "solid", true).error() == "a chunk of the selection is not loaded");
  CHECK(box.narrow(replica, "is ston", true).error().starts_with("where: column 4: "));
  CHECK(box.select({{-500, -500, -500}, {500, 500, 500}}, SelectMode::add));
  box.select(VoxelBox{{-32, -32, -32}, {32, 32, 32}});
  REQUIRE(box.narrow(replica, "solid", true));
  const auto added = box.select({{-500, -500, -500}, {500, 500, 500}}, SelectMode::add);
  REQUIRE_FALSE(added);
  CHECK(added.error() == "more than 4,000,000 voxels, or too many rows of them: select fewer");
  CHECK(box.grow(Direction::pos_y, 4000).error() == added.error());
  CHECK(box.selected().voxels->count() == 64U * 32 * 64);
}

}  // namespace runstone::test
