#include "client/tools/tool_command.hpp"

#include "tests/unit/client/tools/tool_bench.hpp"

using namespace runstone;
using runstone::test::ToolBench;

namespace {

/// A bench over flat ground that carries out commands with material 2 in the hand.
struct CommandBench : ToolBench {
  CommandBench() { show_flat(); }
  ToolEdits run(const ToolCommand& command) { return carry_out(box, replica, 2, command); }
  std::vector<EditDescriptor> edits(const ToolCommand& command) {
    const ToolEdits made = run(command);
    INFO((made ? "" : made.error()));
    REQUIRE(made.has_value());
    return made->edits;
  }
  void type(std::vector<VoxelPos> places, ToolButton button = ToolButton::place,
            Direction face = Direction::pos_y) {
    CHECK(edits(PlacesChange{TypedPlaces{button, std::move(places), face}}).empty());
  }
  EditDescriptor apply() {
    const auto made = edits(TypedApply{});
    REQUIRE(made.size() == 1);
    return made[0];
  }
};

}  // namespace

TEST_CASE_METHOD(CommandBench, "typed places become the edits of clicks at them",
                 "[client_tools]") {
  edits(ToolChoice{"box"});
  type({{3, 4, 5}, {1, 6, 5}});
  CHECK(apply() == EditDescriptor{FillBox{{{1, 4, 5}, {4, 7, 6}}}, {}, 2});
  type({{3, 4, 5}, {1, 6, 5}}, ToolButton::clear);
  CHECK(apply() == EditDescriptor{FillBox{{{1, 4, 5}, {4, 7, 6}}}, {}, kEmpty});
  edits(ToolChoice{"sphere"});
  edits(ParameterChange{"radius", 9});
  type({{0, 0, 0}});
  CHECK(apply() == EditDescriptor{FillSphere{{0, 0, 0}, 9}, {}, 2});
  edits(ParameterChange{"radius", 0});
  type({{0, 0, 0}, {0, 3, 4}});
  CHECK(apply() == EditDescriptor{FillSphere{{0, 0, 0}, 5}, {}, 2});
  edits(ToolChoice{"stroke"});
  type({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}});
  CHECK(apply() == EditDescriptor{FillStroke{{{0, 0, 0}, {5, 0, 0}, {5, 5, 0}}, 2}, {}, 2});
  edits(ToolChoice{"voxel"});
  type({{7, 7, 7}});
  CHECK(apply() == EditDescriptor{SetVoxel{{7, 7, 7}}, {}, 2});
}

TEST_CASE_METHOD(CommandBench, "a typed place of a tool that works on a face needs ground there",
                 "[client_tools]") {
  edits(ToolChoice{"extrude"});
  edits(ParameterChange{"voxels", 1});
  type({{3, -1, 3}});
  predict({apply()});
  CHECK(at({3, 0, 3}) == 1);
  type({{3, 5, 3}});
  CHECK(run(TypedApply{}).error() == "there is only air at that place");
  type({{1000, 0, 0}});
  CHECK(run(TypedApply{}).error() == "that place is not loaded");
  type({{3, 0, 3}}, ToolButton::place, Direction::pos_x);
  predict({apply()});
  CHECK(at({4, 0, 3}) == 1);
}

TEST_CASE_METHOD(CommandBench, "a wrong number of typed places is refused in words",
                 "[client_tools]") {
  CHECK(run(TypedApply{}).error() == "no places are typed");
  edits(ToolChoice{"box"});
  type({{0, 0, 0}});
  CHECK(run(TypedApply{}).error() == "the tool box takes 2 places");
  edits(ToolChoice{"voxel"});
  type({{0, 0, 0}, {1, 1, 1}});
  CHECK(run(TypedApply{}).error() == "the tool voxel takes 1 place");
  edits(ToolChoice{"stroke"});
  type({{0, 0, 0}, {2'000, 0, 0}});
  CHECK_FALSE(run(TypedApply{}).has_value());  // too far for one step of a stroke
}

TEST_CASE_METHOD(CommandBench, "two typed places of the tool that selects are the selection",
                 "[client_tools]") {
  edits(ToolChoice{"select"});
  type({{5, 5, 5}, {2, 8, 5}});
  CHECK(edits(TypedApply{}).empty());
  CHECK(box.selection() == VoxelBox{{2, 5, 5}, {6, 9, 6}});
  edits(SelectionChange{});
  CHECK_FALSE(box.selection());
}

TEST_CASE_METHOD(CommandBench, "the preview shows typed places, and the aim again afterwards",
                 "[client_tools]") {
  edits(ToolChoice{"box"});
  type({{0, 0, 0}, {3, 1, 0}});
  Aim nowhere;  // points at nothing
  nowhere.held = 2;
  while (!box.step_preview(replica, nowhere, 1'000)) continue;
  CHECK(box.preview().placed_voxels() == 8);
  CHECK(box.preview_refusal().empty());
  predict({apply()});
  while (!box.step_preview(replica, nowhere, 1'000)) continue;
  CHECK(box.preview().placed_voxels() == 0);  // it would set what is there
  edits(PlacesChange{});
  box.step_preview(replica, nowhere, 1'000);
  CHECK(box.preview_refusal() == "nothing is in reach");
}

TEST_CASE_METHOD(CommandBench, "commands change the selection, the clipboard and the symmetry",
                 "[client_tools]") {
  using Kind = SelectionCommand::Kind;
  const auto on_selection = [&](Kind kind, Direction direction = Direction::pos_x,
                                std::int32_t count = 1) {
    SelectionCommand command;
    command.kind = kind;
    command.direction = direction;
    command.count = count;
    command.material = 1;
    command.other = 3;
    return edits(command);
  };
  CHECK(run(SelectionCommand{}).error() == "nothing is selected");
  edits(SelectionChange{VoxelBox{{0, -2, 0}, {2, 0, 2}}});
  CHECK(on_selection(Kind::grow, Direction::pos_x, 1).empty());
  CHECK(on_selection(Kind::shift, Direction::pos_z, 4).empty());
  CHECK(box.selection() == VoxelBox{{0, -2, 4}, {3, 0, 6}});
  CHECK(on_selection(Kind::copy).empty());
  REQUIRE(box.clipboard().build);
  const BuildPtr copied = box.clipboard().build;
  CHECK(on_selection(Kind::replace).front().mask == Mask{MaskKind::only_material, 1});
  CHECK(on_selection(Kind::fill).front().material == 1);
  CHECK(on_selection(Kind::clear).front().material == kEmpty);
  CHECK(on_selection(Kind::cut).size() == 1);
  CHECK(on_selection(Kind::stack, Direction::pos_y, 2).size() == 1);
  CHECK(on_selection(Kind::move, Direction::pos_y, 2).size() == 1);
  edits(ClipboardTurn{1, Axis::x});
  CHECK(box.clipboard().build->sides() == VoxelPos{2, 2, 3});
  CHECK(box.clipboard().build->at({1, 1, 0}) == copied->at({2, 1, 1}));
  edits(SymmetryChange{{SymmetryKind::point, 3, 5}});
  CHECK(box.symmetry() == Symmetry{SymmetryKind::point, 3, 5});
  edits(PreviewChange{false});
  CHECK_FALSE(box.is_preview_shown());
  CHECK(run(ToolChoice{"saw"}).error() == "there is no tool saw");
  CHECK_FALSE(run(ParameterChange{"teeth", 3}).has_value());
}
