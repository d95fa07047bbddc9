#include "client/play/edit_tool.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "client/play/player_actions.hpp"
#include "tests/support/codec/authority_model.hpp"
#include "tests/support/codec/chunks_message.hpp"
#include "tests/support/codec/test_keys.hpp"

using namespace runstone;
using runstone::test::keys;

namespace {

constexpr TimeUs kNow = 1'000'000;
constexpr EditPath kPaths[] = {EditPath::local_predicted, EditPath::local_confirmed};

SessionConfig config() {
  SessionConfig out;
  out.keys = keys(1);
  out.instance = 42;
  out.view = {1, {0, 0, 0}, 1, 1};
  return out;
}

template <class T>
T sent(ClientSession& session) {
  for (const Message& message : session.take_outgoing()) {
    if (const auto* wanted = std::get_if<T>(&message)) return *wanted;
  }
  FAIL("the session did not send the expected message");
  return {};
}

/// A session in an open world whose server answers no edit.
struct Fixture {
  Fixture() {
    session.connected({5}, std::nullopt, kNow);
    const Hello hello = sent<Hello>(session);
    const KeyPair server = keys(9);
    Welcome welcome;
    welcome.world_id = {1, 2, 3};
    welcome.chunk_edge = 16;
    welcome.materials = default_material_table();
    welcome.server_key = server.public_key;
    welcome.challenge = {7};
    welcome.view_radius_max = 8;
    welcome.edit_volume_max = 1000;
    welcome.signature = sign(server, server_transcript(hello, welcome, std::nullopt));
    receive(welcome);
    receive(SessionAccepted{6, 0});
    REQUIRE(session.is_open());
  }
  void receive(Message message) { session.receive(std::move(message), {kNow, kNow, kNow}); }
  Result<void, std::string> propose(VoxelPos at) {
    return tool.propose({SetVoxel{at}, {}, 1}, kNow, kNow);
  }
  /// Shows one empty chunk, and copies a cube of 2 voxels a side from it.
  void copy_cube() {
    ChunkSnapshot snapshot;
    snapshot.chunk.voxels = uniform_chunk(Extent::cube(16), kEmpty);
    snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
    receive(runstone::test::chunks_of(std::move(snapshot)));
    box.select(VoxelBox{{0, 0, 0}, {2, 2, 2}});
    REQUIRE(tool.propose(box.fill(session.replica(), 1), kNow).has_value());
    REQUIRE(box.copy(session.replica(), true).has_value());
    REQUIRE(box.choose("paste").has_value());
  }
  Result<void, std::string> paste_cube() {
    TypedPlaces typed;
    typed.places = {{6, 6, 6}};
    box.type_places(typed);
    return tool.propose(box.apply_typed(session.replica(), 1), kNow);
  }
  Result<void, std::string> nudge(Direction direction = Direction::pos_y) {
    return tool.propose(box.nudge(session.replica(), direction), kNow);
  }
  /// Offers edits of a chunk that is not shown until the client accepts no more.
  void fill_local_edits() {
    while (session.replica().local_edits().all().size() < kLocalEditsMax)
      REQUIRE(session.offer({SetVoxel{{1, -5, 3}}, {}, 1}, kNow, kNow).has_value());
  }
  std::uint64_t infinite(EditPath path) const {
    return recorder.report()[path]
        .since_submit[static_cast<std::size_t>(LatencyStage::applied)]
        .infinite();
  }

  ClientSession session{config()};
  Player player;
  LatencyRecorder recorder;
  ToolBox box;
  EditTool tool{session, player, recorder, box};
};

}  // namespace

TEST_CASE_METHOD(Fixture, "an edit in the live world is proposed and counted until it is answered",
                 "[client_app]") {
  REQUIRE(propose({1, 2, 3}).has_value());
  CHECK(tool.refused() == 0);
  CHECK(session.replica().local_edits().all().size() == 1);
  recorder.take(session.replica().drain_changes(), session.clock(), kNow);
  CHECK(infinite(EditPath::local_confirmed) == 1);
}

TEST_CASE_METHOD(Fixture, "an edit in the past is refused with a reason and is in no percentile",
                 "[client_app]") {
  REQUIRE(session.request_history({}).has_value());
  ViewState past;
  past.past = true;
  receive(past);
  REQUIRE(session.replica().past());
  const auto refused = propose({1, 2, 3});
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error() == "the past cannot be edited");
  CHECK(tool.refused() == 1);
  for (const EditPath path : kPaths) {
    CHECK(recorder.report()[path].edits == 0);
    CHECK(infinite(path) == 0);
  }
}

TEST_CASE_METHOD(Fixture, "an edit that finds no room is infinitely late", "[client_app]") {
  for (std::size_t i = 0; i < kLocalEditsMax; ++i)
    REQUIRE(session.offer({SetVoxel{{1, 2, 3}}, {}, 1}, kNow, kNow).has_value());
  REQUIRE_FALSE(propose({1, 2, 3}).has_value());
  CHECK(tool.refused() == 0);
  for (const EditPath path : kPaths) CHECK(infinite(path) == 1);
}

TEST_CASE_METHOD(Fixture, "a click at nothing makes no edit", "[client_app]") {
  CHECK(tool.press(ToolButton::clear, kNow).error() == "nothing is in reach");
  CHECK(tool.press(ToolButton::place, kNow).error() == "nothing is in reach");
  CHECK(tool.refused() == 0);
  CHECK(session.replica().local_edits().all().empty());
}

TEST_CASE_METHOD(Fixture, "a voxel is placed on the ground in sight, but not where the player is",
                 "[client_app]") {
  runstone::test::AuthorityModel world(16);  // solid below 0
  for (const std::int32_t y : {-1, 0})
    receive(runstone::test::chunks_of(world.snapshot({0, y, 0})));
  player.look(0, -std::numbers::pi / 2);
  for (const double inside : {0.5, -0.5}) {
    player.move_to({0.5, inside, 0.5});
    CHECK(tool.press(ToolButton::place, kNow).error() == "you stand there: step back first");
  }
  CHECK(session.replica().local_edits().all().empty());
  player.move_to({0.5, 1.5, 0.5});
  REQUIRE(tool.press(ToolButton::place, kNow).has_value());
  REQUIRE(session.replica().local_edits().all().size() == 1);
}

TEST_CASE_METHOD(Fixture, "the look goes through water, unless the player holds water",
                 "[client_app]") {
  const Material water = *default_material_table().find("water");
  box.set_materials(default_material_table());
  runstone::test::AuthorityModel world(16);
  static_cast<void>(world.commit({9, 1, 1}, {FillBox{{{0, 0, 0}, {4, 3, 4}}}, {}, water}));
  for (const int y : {-1, 0}) receive(runstone::test::chunks_of(world.snapshot({0, y, 0})));
  player.look(0, -std::numbers::pi / 2);
  for (const double y : {5.5, 1.5}) {  // above the water, and in it
    player.move_to({0.5, y, 0.5});
    player.hold(1);
    REQUIRE(tool.pick());
    CHECK(tool.pick()->voxel == VoxelPos{0, -1, 0});
    CHECK(tool.pick()->face == Direction::pos_y);
    player.hold(water);
    REQUIRE(tool.pick());
    CHECK(tool.pick()->material == water);
  }
}

TEST_CASE_METHOD(Fixture, "keys choose tools, and copy, cut and turn a selection", "[client_app]") {
  runstone::test::AuthorityModel world(16);
  receive(runstone::test::chunks_of(world.snapshot({0, -1, 0})));
  const auto act = [&](Action action) {
    const auto done = act_on_tool(tool, action, kNow);
    REQUIRE(done.has_value());
    return *done ? **done : "refused: " + done->error();
  };
  CHECK_FALSE(act_on_tool(tool, Action::help, kNow).has_value());
  CHECK(act(Action::next_tool) == "tool: box");
  CHECK(act(Action::previous_tool) == "tool: voxel");
  CHECK(act(Action::previous_tool) == "tool: array");
  CHECK(act(Action::copy) == "refused: nothing is selected");
  CHECK(act(Action::paste) == "refused: nothing was copied");
  box.select(VoxelBox{{0, -2, 0}, {3, 0, 1}});
  CHECK(act(Action::cut) == "cut");
  REQUIRE(session.replica().local_edits().all().size() == 1);
  CHECK(session.replica().local_edits().all().begin()->second.edit ==
        EditDescriptor{FillBox{{{0, -2, 0}, {3, 0, 1}}}, {}, kEmpty});
  act(Action::rotate);
  act(Action::mirror);
  CHECK(box.clipboard().build->sides() == VoxelPos{1, 2, 3});
  CHECK(act(Action::paste) == "tool: paste");
  CHECK(act(Action::symmetry) == "refused: look at the voxel in the middle of the symmetry first");
  tool.fix_aim(FixedAim{{4, -1, 7}, Direction::pos_y});
  CHECK(act(Action::symmetry) == "tool: paste, mask everything, mirrored along x");
  CHECK(box.symmetry() == Symmetry{SymmetryKind::x, 8, 14});
  CHECK(act(Action::half_symmetry) == "the mirror planes lie between voxels");
  CHECK(box.symmetry() == Symmetry{SymmetryKind::x, 9, 15});
  CHECK(act(Action::half_symmetry) == "the mirror planes lie in the middle of voxels");
  CHECK(box.symmetry() == Symmetry{SymmetryKind::x, 8, 14});
  // A script may set one plane to a border and the other one to a middle. The plane in use counts.
  box.set_symmetry({SymmetryKind::z, 8, 15});
  CHECK(act(Action::half_symmetry) == "the mirror planes lie in the middle of voxels");
  CHECK(box.symmetry() == Symmetry{SymmetryKind::z, 8, 14});
  box.set_symmetry({SymmetryKind::x, 8, 14});
  CHECK(act(Action::preview) == "previews are hidden");
  CHECK(act(Action::select) == "tool: select");
  CHECK(act(Action::larger) == "tool: select, mode add, mirrored along x");
  CHECK(act(Action::smaller) == "tool: select, mode new, mirrored along x");
}

TEST_CASE_METHOD(Fixture, "the box between a corner and the crosshair is measured",
                 "[client_app]") {
  runstone::test::AuthorityModel world(16);
  for (const std::int32_t y : {-1, 0})
    receive(runstone::test::chunks_of(world.snapshot({0, y, 0})));
  for (const char* name : {"box", "select"}) {
    REQUIRE(tool.box().choose(name).has_value());
    CHECK(tool.measure_text().empty());
    tool.fix_aim(FixedAim{{4, -1, 7}, Direction::pos_y});
    REQUIRE(tool.press(ToolButton::clear, kNow).has_value());
    CHECK(tool.measure_text() == "1 x 1 x 1 = 1 voxel   4 -1 7 to 4 -1 7");
    tool.fix_aim(FixedAim{{1, -3, 8}, Direction::pos_y});
    CHECK(tool.measure_text() == "4 x 3 x 2 = 24 voxels   1 -3 7 to 4 -1 8");
    REQUIRE(tool.box().cancel());
    CHECK(tool.measure_text().empty());
  }
  REQUIRE(tool.box().choose("sphere").has_value());
  REQUIRE(tool.box().set_parameter("radius", 0).has_value());
  REQUIRE(tool.press(ToolButton::clear, kNow).has_value());
  CHECK(tool.measure_text().empty());  // its places are a centre and a place on the surface
}

TEST_CASE_METHOD(Fixture, "others see a stroke that is drawn, cut so that it may be shared",
                 "[client_app]") {
  runstone::test::AuthorityModel world(16);
  for (const std::int32_t y : {-1, 0})
    receive(runstone::test::chunks_of(world.snapshot({0, y, 0})));
  player.hold(2);
  REQUIRE(tool.box().choose("terrain").has_value());
  REQUIRE(tool.box().set_parameter("radius", 100).has_value());
  CHECK_FALSE(tool.drawn_stroke().has_value());
  tool.fix_aim(FixedAim{{1, -1, 1}, Direction::pos_y});
  REQUIRE(tool.press(ToolButton::place, kNow).has_value());
  // Others see one place as a ball, and as the brush if they know it.
  REQUIRE(tool.drawn_stroke().has_value());
  CHECK(std::holds_alternative<FillSphere>(tool.drawn_stroke()->line.shape));
  REQUIRE(tool.drawn_stroke()->stroke.has_value());
  CHECK(tool.drawn_stroke()->stroke->places.size() == 1);
  for (const std::int32_t x : {4, 7, 12}) {
    tool.fix_aim(FixedAim{{x, -1, 1}, Direction::pos_y});
    tool.drag();
  }
  const auto stroke = tool.drawn_stroke();
  REQUIRE(stroke.has_value());
  CHECK(may_be_shared({stroke->line}, 16));
  const auto& shape = std::get<FillStroke>(stroke->line.shape);
  CHECK(shape.points.size() == 4);
  CHECK(shape.points.back().x == 12);
  CHECK(shape.radius <= 16);
  CHECK(stroke->line.material == 2);
  // Others see the end of a stroke that is too long to be shared.
  for (std::int32_t i = 0; i < 200; ++i) {
    tool.fix_aim(FixedAim{{1 + i % 14, -1 - i % 15, 1 + i % 13}, Direction::pos_y});
    tool.drag();
  }
  REQUIRE(tool.drawn_stroke().has_value());
  CHECK(may_be_shared({tool.drawn_stroke()->line}, 16));
  CHECK(std::get<FillStroke>(tool.drawn_stroke()->line.shape).points.back() ==
        tool.box().points().back());
  static_cast<void>(tool.release(kNow));
  REQUIRE(tool.drawn_stroke().has_value());  // that of the next click
  CHECK(std::holds_alternative<FillSphere>(tool.drawn_stroke()->line.shape));
}

TEST_CASE_METHOD(Fixture, "a tool previews its next click, and nothing in the past",
                 "[client_app]") {
  runstone::test::AuthorityModel world(16);
  for (const std::int32_t y : {-1, 0})
    receive(runstone::test::chunks_of(world.snapshot({0, y, 0})));
  player.hold(2);
  tool.fix_aim(FixedAim{{4, -1, 7}, Direction::pos_y});
  CHECK_FALSE(tool.step_preview());  // of the plain voxel tool
  REQUIRE(tool.box().choose("fill").has_value());
  CHECK(tool.step_preview());
  REQUIRE(tool.ghosts().size() == 1);
  CHECK(tool.ghosts()[0].placed->quad_count() > 0);
  REQUIRE(tool.box().choose("voxel").has_value());
  CHECK(tool.ghosts().empty());
  REQUIRE(tool.box().choose("fill").has_value());
  while (tool.step_preview()) continue;
  CHECK_FALSE(tool.ghosts().empty());
  REQUIRE(session.request_history({}).has_value());
  ViewState past;
  past.past = true;
  receive(past);
  CHECK(tool.ghosts().empty());
}

TEST_CASE_METHOD(Fixture, "a command that fails leaves the preview as it is", "[client_app]") {
  copy_cube();
  tool.fix_aim(FixedAim{{6, 6, 6}, Direction::pos_y});
  for (int turn = 0; turn < 50; ++turn) tool.step_preview();
  REQUIRE_FALSE(tool.ghosts().empty());
  REQUIRE_FALSE(tool.step_preview());
  CHECK_FALSE(tool.carry_out(PasteNudge{Direction::pos_x}, kNow).has_value());
  for (int turn = 0; turn < 50; ++turn) CHECK_FALSE(tool.step_preview());
  CHECK_FALSE(tool.ghosts().empty());
}

TEST_CASE_METHOD(Fixture, "edits of one action are sent as one, and the next action is another one",
                 "[client_app]") {
  const std::vector<EditDescriptor> two = {{SetVoxel{{1, 2, 3}}, {}, 1},
                                           {SetVoxel{{4, 2, 3}}, {}, 1}};
  session.receive(Pong{kNow - 200, kNow}, {kNow, kNow, kNow});
  REQUIRE(tool.propose(ToolEdits(two), kNow).has_value());
  REQUIRE(propose({9, 9, 9}).has_value());
  REQUIRE(tool.propose(ToolEdits(two), kNow).has_value());
  std::vector<ClientSequence> actions;
  for (const auto& [seq, local] : session.replica().local_edits().all())
    actions.push_back(local.action);
  CHECK(actions == std::vector<ClientSequence>{1, 1, 0, 4, 4});
  actions.clear();
  for (const Message& message : session.take_outgoing()) {
    if (const auto* request = std::get_if<EditRequest>(&message))
      actions.push_back(request->action);
  }
  CHECK(actions == std::vector<ClientSequence>{1, 1, 0, 4, 4});
}

TEST_CASE_METHOD(Fixture, "the steps of a paste that is moved belong to its action",
                 "[client_app]") {
  copy_cube();
  REQUIRE(paste_cube().has_value());
  for (int i = 0; i < 2; ++i) REQUIRE(nudge().has_value());
  REQUIRE(propose({9, 9, 9}).has_value());
  CHECK_FALSE(nudge().has_value());
  std::vector<ClientSequence> actions;
  for (const auto& [seq, local] : session.replica().local_edits().all())
    actions.push_back(local.action);
  CHECK(actions == std::vector<ClientSequence>{0, 2, 2, 2, 0});
}

TEST_CASE_METHOD(Fixture, "a paste of which an edit was refused cannot be moved", "[client_app]") {
  const std::string none =
      "nothing that can be moved was just pasted (a paste of at most 262,144 voxels, not mirrored)";
  copy_cube();
  REQUIRE(paste_cube().has_value());
  REQUIRE(nudge().has_value());
  SECTION("by the client") {
    fill_local_edits();
    REQUIRE_FALSE(nudge().has_value());
  }
  SECTION("by the client, when it is pasted") {
    fill_local_edits();
    REQUIRE_FALSE(paste_cube().has_value());
  }
  SECTION("by the server") {
    const ClientSequence last = session.replica().local_edits().all().rbegin()->first;
    receive(Reject{last, RejectReason::not_permitted, "the ground is protected: spawn", 0});
    tool.take(session.replica().drain_changes(), kNow);
  }
  CHECK(box.nudge(session.replica(), Direction::pos_y).error() == none);
}

TEST_CASE_METHOD(Fixture, "a step that cannot be made leaves the paste where it is",
                 "[client_app]") {
  copy_cube();
  REQUIRE(paste_cube().has_value());
  for (int i = 0; i < 8; ++i) REQUIRE(nudge().has_value());
  for (int i = 0; i < 2; ++i) CHECK(nudge().error() == "the ground is not loaded there");
  REQUIRE(nudge(Direction::neg_y).has_value());
  CHECK(session.replica().shown_at({6, 13, 6}) == Material{1});
  CHECK(session.replica().shown_at({6, 15, 6}) == kEmpty);
}

TEST_CASE_METHOD(Fixture, "a fill larger than one edit is sent in parts, as one action",
                 "[client_app]") {
  box.select(VoxelBox{{0, 0, 0}, {30, 30, 30}});  // 27,000 voxels; an edit has 1,000
  REQUIRE(tool.propose(box.fill(session.replica(), 1), kNow).has_value());
  CHECK(tool.is_building());
  CHECK(session.replica().local_edits().all().empty());
  REQUIRE_FALSE(tool.step_build(kNow).has_value());
  const auto& edits = session.replica().local_edits().all();
  REQUIRE(edits.size() == 1);  // the first one names the action
  CHECK(edits.begin()->second.action == edits.begin()->first);
  CHECK(edits.begin()->second.is_optional);
  CHECK(tool.build_text().starts_with("fill: 0 percent"));
  CHECK(tool.propose(box.fill(session.replica(), 2), kNow).error() ==
        "a fill is under way: wait for it, or stop it first");
  REQUIRE(tool.stop_building());
  const ClientSequence first = edits.begin()->first;
  receive(Reject{first, RejectReason::not_permitted, "the ground is protected: spawn", 0});
  tool.take(session.replica().drain_changes(), kNow);
  const auto ended = tool.step_build(kNow);
  REQUIRE(ended.has_value());
  CHECK(
      ended->starts_with("fill: 0 voxels; left out 512 voxels in 1 part: the ground is protected: "
                         "spawn; it ended early: you have stopped it"));
  CHECK_FALSE(tool.is_building());
  CHECK_FALSE(tool.stop_building());
}

TEST_CASE_METHOD(Fixture,
                 "a fill of many boxes waits for the budget instead of ending in the middle",
                 "[client_app]") {
  receive(Permissions{"builder", 2, 0, "", {1, 3}});
  const auto select = [&](std::int32_t count) {
    box.select(std::nullopt);
    for (std::int32_t i = 0; i < count; ++i)
      REQUIRE(box.select({{2 * i, 0, 0}, {2 * i + 1, 1, 1}}, SelectMode::add).has_value());
  };
  select(8);
  CHECK_FALSE(tool.needs_build(box.fill(session.replica(), 1).value()));
  select(9);
  REQUIRE(tool.propose(box.fill(session.replica(), 1), kNow).has_value());
  CHECK(tool.is_building());
  CHECK(tool.refused() == 0);
  REQUIRE_FALSE(tool.step_build(kNow).has_value());
  CHECK(session.replica().local_edits().all().size() == 1);  // the first one names the action
}

TEST_CASE_METHOD(Fixture, "a clear of any size begins where the selection was copied",
                 "[client_app]") {
  box.select(VoxelBox{{0, 0, 0}, {8, 8, 8}});
  REQUIRE(tool.propose(box.fill(session.replica(), kEmpty), kNow).has_value());
  CHECK_FALSE(tool.is_building());  // one edit suffices
  CHECK(session.replica().local_edits().all().size() == 1);
}
