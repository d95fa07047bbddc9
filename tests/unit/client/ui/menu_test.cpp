#include "client/ui/menu.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

constexpr std::array<int, 2> kMenuSize = {1280, 720};

KeyEvent key_event(Key key, bool is_pressed) {
  KeyEvent out;
  out.place = out.key = key;
  out.is_pressed = is_pressed;
  return out;
}

struct MenuBench {
  std::shared_ptr<const OverlayFrame> title_frames() {
    std::shared_ptr<const OverlayFrame> out;
    for (int i = 0; i < 4; ++i) out = menu.title(title, kMenuSize, 0.02);
    return out;
  }
  void press_on_title(Key key) {
    for (const bool is_pressed : {true, false}) {
      menu.feed({key_event(key, is_pressed)});
      title_frames();
    }
  }
  void press_on_pause(Key key) {
    for (const bool is_pressed : {true, false}) {
      menu.feed({key_event(key, is_pressed)});
      for (int i = 0; i < 4; ++i) static_cast<void>(menu.pause(pause, kMenuSize, 0.02));
    }
  }
  template <class A>
  A only_action() {
    const std::vector<MenuAction> actions = menu.take_actions();
    REQUIRE(actions.size() == 1);
    REQUIRE(std::holds_alternative<A>(actions[0]));
    return std::get<A>(actions[0]);
  }

  Menu menu{ClientSettings{}};
  TitleState title{{}, {}, "ana", "AAAA-BBBB-CCCC", "/keys/ana", "home", {}, "", ""};
  PauseState pause{"castle", "", true};
};

}  // namespace

TEST_CASE_METHOD(MenuBench, "the first button of the title makes a world if there is none",
                 "[client_ui]") {
  title_frames();
  press_on_title(Key::space);
  const auto made = only_action<MakeLocalWorld>();
  CHECK(made.world == "home");
  CHECK(made.name == "ana");
  CHECK(made.generator == "landscape");
  CHECK(made.seed == std::nullopt);
}

TEST_CASE_METHOD(MenuBench, "a world of terrain takes the seed that was typed", "[client_ui]") {
  title_frames();
  // The button for the first world, the name, the ground, the seed, and the button that makes it.
  for (int i = 0; i < 2; ++i) press_on_title(Key::down);
  press_on_title(Key::space);
  press_on_title(Key::down);
  press_on_title(Key::space);
  press_on_title(Key::down);
  press_on_title(Key::enter);
  menu.feed({CharacterEvent{'4'}, CharacterEvent{'2'}});
  title_frames();
  press_on_title(Key::enter);
  press_on_title(Key::down);
  press_on_title(Key::space);
  const auto made = only_action<MakeLocalWorld>();
  CHECK(made.generator == "terrain");
  CHECK(made.seed == 42);
}

TEST_CASE_METHOD(MenuBench, "the first button of the title joins the newest world", "[client_ui]") {
  title.worlds = {{"castle", "just now"}, {"tower", "1 h ago"}};
  title_frames();
  press_on_title(Key::space);
  CHECK(only_action<JoinLocalWorld>().world == "castle");
  press_on_title(Key::down);
  press_on_title(Key::space);
  CHECK(only_action<JoinLocalWorld>().world == "tower");
}

TEST_CASE_METHOD(MenuBench, "a password is typed and given with enter", "[client_ui]") {
  title.asks_password_of = "example.org:4747";
  title_frames();
  menu.feed({CharacterEvent{'b'}, CharacterEvent{'l'}, CharacterEvent{U'ü'}});
  title_frames();
  CHECK(menu.take_actions().empty());
  press_on_title(Key::enter);
  CHECK(only_action<GivePassword>().password == "bl\u00fc");
}

TEST_CASE_METHOD(MenuBench, "the pause menu goes on, leaves and quits", "[client_ui]") {
  for (int i = 0; i < 4; ++i) static_cast<void>(menu.pause(pause, kMenuSize, 0.02));
  press_on_pause(Key::space);
  only_action<ResumePlay>();
  press_on_pause(Key::down);
  press_on_pause(Key::down);
  press_on_pause(Key::space);
  only_action<LeaveServer>();
  press_on_pause(Key::down);
  press_on_pause(Key::space);
  only_action<QuitProgram>();
}

TEST_CASE_METHOD(MenuBench, "keys that came before the first frame of a screen count on it",
                 "[client_ui]") {
  std::vector<InputEvent> events;
  for (const Key key : {Key::down, Key::down, Key::down, Key::space}) {
    for (const bool is_pressed : {true, false}) events.emplace_back(key_event(key, is_pressed));
  }
  menu.reset();
  menu.feed(events);
  static_cast<void>(menu.pause(pause, kMenuSize, 0.02));
  only_action<QuitProgram>();
}

TEST_CASE_METHOD(MenuBench, "a failure is drawn above the lists", "[client_ui]") {
  const std::size_t before = title_frames()->vertices.size();
  title.failure = {"The server is full", "no room for one more player"};
  CHECK(title_frames()->vertices.size() > before + 100);
}

}  // namespace runstone
