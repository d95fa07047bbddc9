// The turns of a player, without a network, a window and threads.
#include "client/play/play.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "client/render/author_rgb.hpp"
#include "common/core/world_time.hpp"
#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test::play_test {

using namespace session_bench;

namespace {

struct RecordedLog final : PlayLog {
  void on_edit_refused(const std::string& why) override { refused.push_back(why); }
  void on_changes(const ReplicaChanges& changes, std::span<const PlayerNotice> state) override {
    rejects += changes.rejects.size();
    states += state.size();
  }
  void on_new_materials(std::size_t count) override { new_materials += count; }

  std::vector<std::string> refused;
  std::size_t rejects = 0, states = 0, new_materials = 0;
};

/// A player in a world of solid ground below height 0.
struct PlayBench : SessionBench {
  PlayBench() {
    server.features = kFeaturePreviews | kFeatureCommands | kFeatureChat;
    static_cast<void>(open());
    turn(true);
  }
  static PlayConfig config() {
    PlayConfig out;
    out.wishes = {256, {1, 1}, 0};
    out.is_watched = false;
    return out;
  }
  /// Makes a turn as the programs do. Returns the input that was not the player's.
  RoutedInput turn(bool is_opened = false) {
    now += 20'000;
    play.begin_turn(is_opened, {}, now);
    const RoutedInput routed = play.handle_input({}, settings, now);
    for (const Action action : routed.player.actions) static_cast<void>(play.act(action, now));
    play.take_changes(now);
    play.follow(now);
    session.tick(now);
    play.take_changes(now);
    play.step_previews(settings, now);
    return routed;
  }
  void show_ground() {
    for (const std::int32_t y : {-1, 0}) receive(chunks_of(server.world.snapshot({0, y, 0})));
    play.player().move_to({8.5, 3.5, 8.5});
    play.player().look(0, -std::numbers::pi / 2);
    turn();
  }
  /// Returns the colours of the ghosts of other players in a frame.
  std::vector<std::array<std::uint8_t, 3>> tints() {
    std::vector<std::array<std::uint8_t, 3>> out;
    for (const GhostChunk& ghost : play.frame({}, now).contents.ghosts) {
      if (ghost.tint) out.push_back(*ghost.tint);
    }
    return out;
  }
  std::vector<std::string> notices() {
    std::vector<std::string> out;
    for (const PlayerNotice& notice : play.take_notices()) out.push_back(notice.text);
    return out;
  }

  RecordedLog log;
  ToolBox tools;
  PlaySettings settings;
  Play play{session, tools, nullptr, log, config()};
};

}  // namespace

TEST_CASE_METHOD(PlayBench, "a world that opens has its materials in every part", "[client]") {
  CHECK(play.was_opened());
  CHECK(play.pipeline().materials().size() == default_material_table().size());
  CHECK(play.hotbar().slots()[0] != kEmpty);
  CHECK(play.player().held() == play.hotbar().slots()[0]);
  CHECK(play.player().eye() == server.welcome.spawn);
  CHECK(session.view().centre == play.player().chunk(kEdge));
  CHECK_FALSE(play.has_ground(1'000'000, now));
  CHECK(play.has_ground(1'000'000, now + 2'000'000));
}

TEST_CASE_METHOD(PlayBench, "after a lost connection the player has the same place and hotbar",
                 "[client]") {
  play.player().move_to({3, 4, 5});
  play.hotbar().choose(4);
  session.disconnected();
  static_cast<void>(open());
  turn(true);
  CHECK(play.player().eye() == WorldPos{3, 4, 5});
  CHECK(play.hotbar().slot() == 4);
  session.disconnected();
  server.world_id = {9};
  static_cast<void>(open());
  turn(true);
  CHECK(play.player().eye() == server.welcome.spawn);
  CHECK(play.hotbar().slot() == 0);
}

TEST_CASE_METHOD(PlayBench, "frames show the time of the world, or the time that the player chose",
                 "[client]") {
  const auto shown = [this] {
    turn();
    return play.pipeline().look().time_of_day();
  };
  CHECK(shown() == FrameLook{}.time_of_day);
  server.features |= kFeatureWorldTime;
  session.disconnected();
  static_cast<void>(open());
  receive(WorldTime{kDayMs / 4, 0});
  CHECK(shown() == 0.25);
  play.set_own_time(0.75);
  CHECK(shown() == 0.75);
  receive(WorldTime{kDayMs / 2, 3600});
  CHECK(shown() == 0.75);
  play.set_own_time(std::nullopt);
  const double noon = shown();
  CHECK(noon >= 0.5);
  CHECK(noon < 0.51);
  now += 1'000'000;  // an hour of the world
  CHECK(shown() > noon);
}

TEST_CASE_METHOD(PlayBench, "the display names who set the voxel at the crosshair, and when",
                 "[client]") {
  server.features |= kFeatureLogMarks | kFeatureVoxelAuthors;
  session.disconnected();
  static_cast<void>(open());
  show_ground();
  const auto shown = [this] {
    for (int i = 0; i < 40; ++i) {
      turn();
      play.step_author(settings, now);
      for (const LogMarksRequest& request : take<LogMarksRequest>(sent()))
        receive(LogMarks{request.request, 1, {{5, 1'000'000, 7, Cause::undo}}, {{7, "ann"}}, ""});
    }
    HudState state;
    play.fill(state, {});
    return state.author;
  };
  CHECK(shown() == "ann, 1970-01-01T00:00:01Z, undo");
  settings.shows_authors = false;
  CHECK(shown().empty());
}

TEST_CASE_METHOD(PlayBench, "hotbar and tool come back that were kept for a world", "[client]") {
  CHECK(play.take_kits().empty());
  play.hotbar().choose(2);
  REQUIRE(tools.choose("sphere"));
  const auto taken = play.take_kits();
  REQUIRE(taken.size() == 1);
  const KeptKit& kept = taken.front();
  CHECK(kept.world == session.welcome()->world_id);
  CHECK(kept.kit.slot == 2);
  CHECK(kept.kit.tool == "sphere");
  CHECK(play.take_kits().empty());
  PlayConfig next = config();
  next.kit_of = [&](const WorldId&) { return std::optional(kept.kit); };
  ToolBox others;
  Play again{session, others, nullptr, log, next};
  again.begin_turn(true, {}, now);
  CHECK(again.hotbar().slot() == 2);
  CHECK(again.player().held() == kept.kit.slots[2]);
  CHECK(others.tool().name() == "sphere");
  CHECK(again.take_kits().empty());
}

TEST_CASE_METHOD(PlayBench, "the kit of a world is kept when another world opens", "[client]") {
  const WorldId first = session.welcome()->world_id;
  play.hotbar().choose(2);
  REQUIRE(tools.choose("sphere"));
  session.disconnected();
  server.world_id = {7, 7};
  static_cast<void>(open());
  turn(true);
  REQUIRE(session.welcome()->world_id != first);
  const auto taken = play.take_kits();
  REQUIRE(taken.size() == 1);
  CHECK(taken[0].world == first);
  CHECK(taken[0].kit.slot == 2);
  CHECK(taken[0].kit.tool == "sphere");
}

TEST_CASE_METHOD(PlayBench, "hotbars are kept, taken and forgotten by their names", "[client]") {
  using What = HotbarOrder::What;
  const auto before = play.hotbar().slots();
  CHECK_FALSE(play.take_hotbars());
  play.carry_out(HotbarOrder{What::keep, "first"}, now);
  CHECK(notices() == std::vector<std::string>{"the hotbar \"first\" is kept"});
  const auto kept = play.take_hotbars();
  REQUIRE(kept);
  CHECK(kept->at("first").size() == kSlotCount);
  CHECK_FALSE(play.take_hotbars());
  play.carry_out(HoldMaterial{*default_material_table().find("gold")}, now);
  CHECK(play.hotbar().slots() != before);
  REQUIRE(play.carry_out(HotbarOrder{What::take, "first"}));
  CHECK(play.hotbar().slots() == before);
  HudState state;
  play.fill(state, {});
  CHECK(state.hotbars == std::vector<std::string>{"first"});
  CHECK(state.recent == std::vector<Material>{*default_material_table().find("gold")});
  REQUIRE(play.carry_out(HotbarOrder{What::forget, "first"}));
  CHECK_FALSE(play.carry_out(HotbarOrder{What::take, "first"}));
  CHECK(play.take_hotbars()->empty());
}

TEST_CASE_METHOD(PlayBench, "the middle button picks the voxel in sight into a slot", "[client]") {
  show_ground();
  play.input().capture();
  const Material seen = *session.replica().shown_at({8, -1, 8});
  play.hotbar().choose(5);
  play.input().push(
      {ButtonEvent{MouseButton::middle, true}, ButtonEvent{MouseButton::middle, false}});
  turn();
  CHECK(play.player().held() == seen);
}

TEST_CASE_METHOD(PlayBench, "a click edits the ground, and a key of a tool changes the tool",
                 "[client]") {
  show_ground();
  play.input().capture();
  play.input().push({ButtonEvent{MouseButton::left, true}, ButtonEvent{MouseButton::left, false}});
  turn();
  REQUIRE(session.replica().local_edits().all().size() == 1);
  CHECK(session.replica().shown_at({8, -1, 8}) == kEmpty);
  CHECK(play.act(Action::next_tool, now));
  CHECK(notices() == std::vector<std::string>{"tool: box"});
  HudState state;
  play.fill(state, {});
  CHECK(state.is_captured);
  CHECK(state.sight == VoxelPos{8, -2, 8});
  CHECK(state.slots == play.hotbar().slots());
}

TEST_CASE_METHOD(PlayBench, "a play leaves the actions of the interface to its program",
                 "[client]") {
  for (const Action action : {Action::chat, Action::palette, Action::map, Action::timeline,
                              Action::screenshot, Action::ground, Action::release, Action::help})
    CHECK_FALSE(play.act(action, now));
  CHECK(play.act(Action::walk_or_fly, now));
  CHECK(play.player().is_walking());
  turn();
  CHECK(play.state_text() == "the ground here has not arrived yet");
  CHECK(play.act(Action::hold_slot_3, now));
  CHECK(play.hotbar().slot() == 2);
  CHECK(play.act(Action::undo, now));
  const auto commands = take<CommandRequest>(sent());
  REQUIRE(commands.size() == 1);
  CHECK(commands[0].text == "undo");
  CHECK(play.act(Action::redo, now));  // the command before is still running
  const auto lines = play.chat().take_lines();
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].tone == ChatTone::refused);
}

TEST_CASE_METHOD(PlayBench,
                 "an undo stops an action of which nothing was sent, and undoes no other",
                 "[client]") {
  show_ground();
  tools.select(VoxelBox{{0, 0, 0}, {256, 256, 256}});
  REQUIRE(play.tool().propose(tools.fill(session.replica(), 1), now));
  REQUIRE(play.tool().is_building());
  CHECK(play.act(Action::undo, now));
  CHECK(take<CommandRequest>(sent()).empty());
  turn();
  CHECK_FALSE(play.tool().is_building());
  CHECK(session.replica().local_edits().all().empty());
  REQUIRE(play.tool().propose(tools.fill(session.replica(), 1), now));
  turn();
  CHECK(session.replica().local_edits().all().size() == 1);
  CHECK(play.act(Action::undo, now));
  CHECK(take<CommandRequest>(sent()).size() == 1);
}

TEST_CASE_METHOD(PlayBench, "a paste cannot be moved after an undo by key or by chat", "[client]") {
  show_ground();
  tools.select(VoxelBox{{0, -2, 0}, {2, 0, 2}});
  REQUIRE(tools.copy(session.replica(), true));
  REQUIRE(tools.choose("paste"));
  TypedPlaces typed;
  typed.places = {{6, 4, 6}};
  for (const bool is_typed : {true, false}) {
    CAPTURE(is_typed);
    tools.type_places(typed);
    REQUIRE(play.tool().propose(tools.apply_typed(session.replica(), 1), now));
    REQUIRE(play.tool().propose(tools.nudge(session.replica(), Direction::pos_y), now));
    if (is_typed) {
      play.carry_out(SendLine{"/undo"}, now);
    } else {
      CHECK(play.act(Action::undo, now));
    }
    CHECK_FALSE(tools.nudge(session.replica(), Direction::pos_y));
  }
}

TEST_CASE_METHOD(PlayBench, "what the server refuses is a notice, and the log gets it",
                 "[client]") {
  show_ground();
  REQUIRE(play.tool().press(ToolButton::clear, now));
  const ClientSequence seq = session.replica().local_edits().all().begin()->first;
  Reject reject;
  reject.client_seq = seq;
  reject.reason = RejectReason::bad_edit;
  receive(reject);
  turn();
  CHECK(log.rejects == 1);
  CHECK(notices() == std::vector<std::string>{notice_of({0, reject.reason, ""}).text});
  play.carry_out(ToolCommand{SelectionCommand{SelectionCommand::Kind::clear}}, now);
  CHECK(notices() == std::vector<std::string>{"nothing is selected"});
}

TEST_CASE_METHOD(PlayBench, "players see the previews of one another", "[client][preview]") {
  show_ground();
  receive(PlayerList{{{8, "ben", keys(3).public_key}}, false, {}});
  receive(PlayerPreview{8, {{FillBox{{{3, -1, 3}, {5, 1, 5}}}, {}, 2}}});
  for (int i = 0; i < 5; ++i) turn();
  REQUIRE_FALSE(tints().empty());
  CHECK(tints()[0] == author_rgb(8));
  settings.shows_previews = false;
  turn();
  CHECK(tints().empty());
  settings.shows_previews = true;
  for (int i = 0; i < 5; ++i) turn();
  CHECK_FALSE(tints().empty());
  CHECK(play.act(Action::preview, now));  // hides all previews
  turn();
  CHECK(tints().empty());
}

TEST_CASE_METHOD(PlayBench, "the preview of the player's next click is shared",
                 "[client][preview]") {
  show_ground();
  static_cast<void>(sent());
  turn();
  CHECK(take<PreviewShare>(sent()).empty());  // the plain voxel tool has no preview
  REQUIRE(tools.choose("box"));
  settings.shares_previews = false;
  turn();
  CHECK(take<PreviewShare>(sent()).empty());
  settings.shares_previews = true;
  turn();
  const auto shared = take<PreviewShare>(sent());
  REQUIRE(shared.size() == 1);
  CHECK(shared[0].edits == tools.preview().edits());
}

}  // namespace runstone::test::play_test
