#include "client/ui/hud.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "client/ui/heads_up.hpp"

using namespace runstone;

namespace {

constexpr std::array<int, 2> kHudSize = {640, 480};

HudState some_state() {
  HudState state;
  state.materials = &default_material_table();
  state.slots = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  state.is_captured = true;
  state.is_connected = true;
  return state;
}

KeyEvent hud_key(Key which, bool is_pressed) {
  KeyEvent event;
  event.place = event.key = which;
  event.is_pressed = is_pressed;
  return event;
}

/// A display with a router, as a client has them.
struct HudBench {
  /// Routes the events and makes frames until all are handled. Returns the actions that the display
  /// did not carry out.
  std::vector<Action> turn(const std::vector<InputEvent>& events) {
    std::vector<Action> left;
    router.push(events);
    do {
      const RoutedInput routed = router.route(hud.focus());
      for (const Action action : routed.player.actions) {
        if (!hud.act(action)) left.push_back(action);
      }
      hud.feed(routed.for_ui);
      frame();
      router.set_windows(hud.focus().has_window, hud.focus().panels);
    } while (router.has_events());
    return left;
  }
  std::vector<Action> press(Key key) { return turn({hud_key(key, true), hud_key(key, false)}); }
  void type(std::string_view text) {
    std::vector<InputEvent> events;
    for (const char c : text) events.emplace_back(CharacterEvent{static_cast<char32_t>(c)});
    turn(events);
  }
  void click(double x, double y) {
    turn({CursorEvent{x, y, 0, 0}, ButtonEvent{MouseButton::left, true},
          ButtonEvent{MouseButton::left, false}});
  }
  std::size_t frame(double seconds = 0.016) {
    const auto made = hud.make_frame(state, kHudSize, seconds);
    for (UiAction& action : hud.take_actions()) actions.push_back(std::move(action));
    return made->vertices.size();
  }
  /// Returns the only action of the user since the last call.
  template <class T>
  T take() {
    REQUIRE(actions.size() == 1);
    REQUIRE(std::holds_alternative<T>(actions[0]));
    T out = std::get<T>(actions[0]);
    actions.clear();
    return out;
  }

  InputRouter router;
  Hud hud{KeyMap{}};
  HudState state = some_state();
  std::vector<UiAction> actions;
};

}  // namespace

TEST_CASE_METHOD(HudBench,
                 "a line is typed after its key, sent by enter, and comes back by the arrows",
                 "[client_ui]") {
  click(320, 100);
  REQUIRE(router.is_captured());
  CHECK(press(Key::t).empty());
  CHECK_FALSE(router.is_captured());
  frame();
  type("hello all");
  CHECK(actions.empty());
  press(Key::enter);
  CHECK(take<SendLine>().text == "hello all");
  CHECK(router.is_captured());  // as before
  press(Key::slash);
  frame();
  type("players");
  press(Key::enter);
  CHECK(take<SendLine>().text == "/players");
  press(Key::enter);  // opens the chat again
  frame();
  press(Key::up);
  press(Key::up);
  press(Key::enter);
  CHECK(take<SendLine>().text == "hello all");
}

TEST_CASE_METHOD(HudBench, "escape closes the chat without sending, and an empty line is not sent",
                 "[client_ui]") {
  press(Key::t);
  frame();
  type("oops");
  CHECK(press(Key::escape).empty());
  CHECK_FALSE(hud.focus().has_window);
  press(Key::t);
  frame();
  press(Key::enter);
  CHECK_FALSE(hud.focus().has_window);
  CHECK(actions.empty());
  CHECK(press(Key::escape) == std::vector<Action>{Action::release});  // nothing is open any more
}

TEST_CASE_METHOD(HudBench, "new lines of chat are shown for some seconds", "[client_ui]") {
  frame();
  const std::size_t without = frame(20);
  hud.hear({"<ana> hello", ChatTone::player});
  frame(0.1);  // the size of the window is found
  CHECK(frame(0.1) > without);
  CHECK_FALSE(hud.is_moving());  // nothing changes until the line fades
  frame(ChatWindow::kShownSeconds);
  CHECK(hud.is_moving());
  frame(20);
  CHECK(frame() == without);
  CHECK_FALSE(hud.is_moving());
}

TEST_CASE_METHOD(HudBench,
                 "the palette finds a material by its name and takes it by enter or a click",
                 "[client_ui]") {
  press(Key::e);
  CHECK(hud.focus().has_window);
  frame();
  type("wool vio");
  press(Key::enter);
  const Material violet = *default_material_table().find("wool_violet");
  CHECK(take<HoldMaterial>().material == violet);
  CHECK_FALSE(hud.focus().has_window);
  press(Key::e);
  frame();
  type("nosuch");
  press(Key::enter);
  CHECK(actions.empty());
  CHECK(press(Key::escape).empty());
  press(Key::e);
  frame();
  click(200, 150);  // the first cell is below the search
  CHECK(take<HoldMaterial>().material != kEmpty);
}

TEST_CASE_METHOD(HudBench, "the palette offers what was used lately, and keeps hotbars",
                 "[client_ui]") {
  press(Key::e);
  frame();
  const std::size_t without = frame();
  state.recent = {5, 6};
  state.hotbars = {"roofs"};
  frame();
  CHECK(frame() != without);
  click(150, 150);  // the first icon, below the orders
  CHECK(take<HoldMaterial>().material == 5);
  press(Key::e);
  frame();
  click(180, 354);  // the field for a name, at the lower edge
  type("walls");
  click(285, 354);
  const auto order = take<HotbarOrder>();
  CHECK(order.what == HotbarOrder::What::keep);
  CHECK(order.name == "walls");
  CHECK(hud.focus().has_window);  // the window stays open
}

TEST_CASE("materials match by all words of a search, and a name that begins with it comes first",
          "[client_ui]") {
  const MaterialTable& table = default_material_table();
  CHECK(matching_materials(table, "").size() == table.size() - 1);  // all but air
  const auto stones = matching_materials(table, "stone");
  REQUIRE(stones.size() == 3);
  CHECK(table[stones[0]].name == "stone");
  CHECK(table[stones[1]].name == "stone_brick");
  CHECK(table[stones[2]].name == "sandstone");
  CHECK(matching_materials(table, "BRICK stone").size() == 1);
  CHECK(matching_materials(table, "bedrock").empty());
  CHECK(table[matching_materials(table, "ool whi").at(0)].name == "wool_white");  // parts of words
  // Names that begin with the text, then those of which another word does, then the others.
  const auto names = [&](const std::string& text) {
    std::vector<std::string> out;
    for (const Material id : matching_materials(table, text)) out.push_back(table[id].name);
    return out;
  };
  CHECK(names("gr") == std::vector<std::string>{"grass", "gravel", "wool_grey", "wool_green"});
  CHECK(names("bri") == std::vector<std::string>{"brick", "stone_brick"});
}

TEST_CASE_METHOD(HudBench, "help opens and closes by its key and by escape", "[client_ui]") {
  frame();
  const std::size_t without = frame(20);
  press(Key::f1);
  frame();
  CHECK(frame() > without);
  CHECK(hud.focus().scrolls);  // the arrows are not actions of the player
  CHECK(press(Key::down).empty());
  press(Key::f1);
  CHECK(frame() == without);
  CHECK_FALSE(hud.focus().scrolls);
  press(Key::f1);
  CHECK(press(Key::escape).empty());
  CHECK(frame() == without);
}

TEST_CASE("help fits a frame of 1024 x 576 in its width, and scrolls to its last row by keys",
          "[client_ui]") {
  constexpr std::array<int, 2> kSmall = {1024, 576};
  Hud hud{KeyMap{}};
  const HudState state = some_state();
  hud.act(Action::help);
  const auto frame = [&] { return hud.make_frame(state, kSmall, 0.016); };
  for (int i = 0; i < 4; ++i) frame();
  const auto top = frame();
  // Texts that are cut by the window would have corners outside of it.
  float right = 0, bottom = 0;
  for (const OverlayVertex& vertex : top->vertices) {
    right = std::max(right, vertex.x);
    bottom = std::max(bottom, vertex.y);
  }
  CHECK(right <= 1024);
  CHECK(bottom <= 576);
  CHECK_FALSE(hud.act(Action::earlier));
  CHECK(hud.act(Action::next_tool));
  for (int i = 0; i < 2; ++i) frame();
  const auto below = frame();
  CHECK(below->vertices != top->vertices);
  for (int i = 0; i < 20; ++i) hud.act(Action::previous_tool);
  for (int i = 0; i < 2; ++i) frame();
  CHECK(frame()->vertices == top->vertices);
  hud.feed({hud_key(Key::down, true), hud_key(Key::down, false)});
  for (int i = 0; i < 3; ++i) frame();
  CHECK(frame()->vertices != top->vertices);
  hud.act(Action::help);
  CHECK_FALSE(hud.act(Action::next_tool));
}

TEST_CASE_METHOD(HudBench, "page up scrolls an open chat to its older lines", "[client_ui]") {
  for (int i = 0; i < 200; ++i) hud.hear({"line " + std::to_string(i), ChatTone::answer});
  press(Key::t);
  for (int i = 0; i < 3; ++i) frame();
  const auto shown = [this] { return hud.make_frame(state, kHudSize, 0.016)->vertices; };
  const auto newest = shown();
  press(Key::page_up);
  frame();
  CHECK(shown() != newest);
  for (int i = 0; i < 3; ++i) press(Key::page_down);
  frame();
  CHECK(shown() == newest);
}

TEST_CASE_METHOD(HudBench, "a key lets the keyboard press the buttons of the open windows",
                 "[client_ui]") {
  CHECK(press(Key::f9).empty());  // no window is open
  CHECK(press(Key::b) == std::vector<Action>{Action::select});
  state.timeline = {1'000, 500, true, false, ""};
  press(Key::h);
  for (int i = 0; i < 3; ++i) frame();
  CHECK(press(Key::b) == std::vector<Action>{Action::select});
  press(Key::f9);
  CHECK(press(Key::b).empty());
  bool has_moved = false;
  for (int i = 0; i < 12 && !has_moved; ++i) {
    press(i < 2 ? Key::down : Key::right);
    press(Key::space);
    for (const UiAction& action : actions)
      has_moved = has_moved || std::holds_alternative<ShowMoment>(action);
    actions.clear();
  }
  CHECK(has_moved);
  press(Key::f9);
  CHECK(press(Key::b) == std::vector<Action>{Action::select});
  press(Key::f9);
  CHECK(press(Key::escape).empty());  // closes the window, and the player has the keyboard
  frame();
  CHECK(press(Key::b) == std::vector<Action>{Action::select});
}

TEST_CASE_METHOD(HudBench,
                 "the timeline asks for a moment where its slider is clicked, and for live",
                 "[client_ui]") {
  state.timeline = {1'000, 1'000, false, false, ""};
  press(Key::h);
  frame();
  click(320, 78);  // the middle of the slider
  const auto moment = take<ShowMoment>();
  CHECK_FALSE(moment.is_live);
  CHECK(moment.seq > 400);
  CHECK(moment.seq < 600);
  state.timeline.is_past = true;
  state.timeline.shown = moment.seq;
  frame();
  frame();
  CHECK(actions.empty());  // it is shown
  click(590, 78);
  CHECK(take<ShowMoment>().seq > 900);
  state.timeline.is_loading = true;
  click(100, 78);
  CHECK(actions.empty());  // the moment before is not here yet
  state.timeline.is_loading = false;
  frame();
  CHECK(take<ShowMoment>().seq < 200);
}

TEST_CASE_METHOD(HudBench, "the measurements are shown by F3 and do not take the mouse",
                 "[client_ui]") {
  frame();
  const std::size_t without = frame(20);
  state.statistics.frame_ms = {8, 9, 30};
  state.statistics.stages.fill("stage");
  state.statistics.edits = {{true, {-1, -1, -1, 1, 2, 3, 9}}, {false, {4, 5, 5, 6, 7, 8, 12}}};
  press(Key::f3);
  frame();
  CHECK(frame() > without);
  CHECK(hud.shows_statistics());
  CHECK_FALSE(hud.focus().has_window);
  CHECK(press(Key::w).empty());
  press(Key::f3);
  CHECK(frame() == without);
}

TEST_CASE_METHOD(HudBench, "the boxes of the measurements choose what is inspected, with a legend",
                 "[client_ui]") {
  press(Key::f3);
  frame();
  frame();
  const std::size_t without = frame();
  // The boxes are the only things in this window that a click changes: try places until one does.
  const auto* chosen = [&]() -> const SetInspection* {
    for (double y = 124; y < 240; y += 6) {
      click(140, y);
      for (const UiAction& action : actions) {
        if (const auto* set = std::get_if<SetInspection>(&action)) return set;
      }
    }
    return nullptr;
  }();
  REQUIRE(chosen != nullptr);
  CHECK(chosen->modes.any());
  state.inspection.set(InspectionMode::orders, true);
  frame();                         // ImGui measures a new window first
  CHECK(frame() > without + 100);  // the legend of six orders
  press(Key::f3);
  CHECK(frame() > 100);  // the legend stays without the measurements
}

TEST_CASE("the name of another material in the hand is shown and fades", "[client_ui]") {
  Hud hud{KeyMap{}};
  HudState state = some_state();
  const auto size_after = [&](double seconds) {
    return hud.make_frame(state, kHudSize, seconds)->vertices.size();
  };
  size_after(0);
  const std::size_t faded = size_after(10);
  CHECK_FALSE(hud.is_moving());
  state.slot = 3;
  CHECK(size_after(0.01) > faded);
  size_after(kSlotNameSeconds - kSlotNameFadeSeconds + 0.1);
  CHECK(hud.is_moving());
  CHECK(size_after(10) == faded);
}

TEST_CASE("a notice stays for some seconds, and a repeated one is counted", "[client_ui]") {
  Hud hud{KeyMap{}};
  const HudState state = some_state();
  hud.make_frame(state, kHudSize, 0);
  const std::size_t without = hud.make_frame(state, kHudSize, 10)->vertices.size();
  hud.notify("nothing is in reach", NoticeKind::warning);
  CHECK(hud.is_moving());
  const std::size_t once = hud.make_frame(state, kHudSize, 0.1)->vertices.size();
  CHECK(once > without);
  hud.notify("nothing is in reach", NoticeKind::warning);
  const std::size_t twice = hud.make_frame(state, kHudSize, 0.1)->vertices.size();
  CHECK(twice > once);                   // the count is longer
  CHECK(twice - once < once - without);  // but it is no second line
  CHECK_FALSE(hud.is_moving());          // nothing changes until it fades
  hud.make_frame(state, kHudSize, NoticeList::kShownSeconds);
  CHECK(hud.is_moving());
  CHECK(hud.make_frame(state, kHudSize, NoticeList::kFadeSeconds)->vertices.size() == without);
  CHECK_FALSE(hud.is_moving());
}

TEST_CASE("notices are drawn after all windows, wrapped, and inside the frame", "[client_ui]") {
  Hud hud{KeyMap{}};
  const HudState state = some_state();
  hud.act(Action::help);
  for (int i = 0; i < 3; ++i) hud.make_frame(state, kHudSize, 10);
  const auto before = hud.make_frame(state, kHudSize, 0.1);
  for (int i = 0; i < 20; ++i) {
    std::string text = std::to_string(i);
    for (int word = 0; word < 60; ++word) text += " the ground is protected";
    hud.notify(std::move(text), NoticeKind::warning);
  }
  const auto after = hud.make_frame(state, kHudSize, 0.1);
  REQUIRE(after->vertices.size() > before->vertices.size());
  CHECK(std::equal(before->vertices.begin(), before->vertices.end(), after->vertices.begin()));
  for (std::size_t i = before->vertices.size(); i < after->vertices.size(); ++i) {
    const OverlayVertex& vertex = after->vertices[i];
    REQUIRE(vertex.x >= 0);
    REQUIRE(vertex.x <= static_cast<float>(kHudSize[0]));
    REQUIRE(vertex.y >= 0);
    REQUIRE(vertex.y <= static_cast<float>(kHudSize[1]));
  }
}

TEST_CASE("the quality of the connection has a form: bars that are full, and a slow ping in words",
          "[client_ui]") {
  Hud hud{KeyMap{}};
  HudState state = some_state();
  hud.make_frame(state, kHudSize, 0);
  const auto vertices = [&](std::optional<double> ping_ms) {
    state.ping_ms = ping_ms;
    return hud.make_frame(state, kHudSize, 10)->vertices.size();
  };
  const std::size_t without = vertices(std::nullopt), fast = vertices(20);
  CHECK(fast > without);
  CHECK(vertices(100) != fast);
  CHECK(vertices(500) > vertices(100));
  state.is_connected = false;
  const std::size_t lost = vertices(std::nullopt);
  CHECK(vertices(20) == lost);
}

TEST_CASE("the author of the voxel in sight is a line of the display", "[client_ui]") {
  Hud hud{KeyMap{}};
  HudState state = some_state();
  hud.make_frame(state, kHudSize, 0);
  const std::size_t without = hud.make_frame(state, kHudSize, 10)->vertices.size();
  state.author = "ann, 1970-01-01T00:00:01Z";
  CHECK(hud.make_frame(state, kHudSize, 0.1)->vertices.size() > without);
}

TEST_CASE("the hint to click is shown while the mouse is free", "[client_ui]") {
  Hud hud{KeyMap{}};
  HudState state = some_state();
  hud.make_frame(state, kHudSize, 0);
  const std::size_t captured = hud.make_frame(state, kHudSize, 10)->vertices.size();
  state.is_captured = false;
  CHECK(hud.make_frame(state, kHudSize, 0.1)->vertices.size() > captured);
}
