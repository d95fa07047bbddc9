#include "client/input/key_map.hpp"

#include <catch2/catch.hpp>
#include <set>

using namespace runstone;

namespace {

KeyEvent press(Key key, bool control = false, bool shift = false) {
  KeyEvent event;
  event.place = event.key = key;
  event.is_pressed = true;
  event.control = control;
  event.shift = shift;
  return event;
}

}  // namespace

TEST_CASE("every key has a name that finds it", "[client_input]") {
  std::set<std::string_view> names;
  for (std::size_t i = 1; i < kKeyCount; ++i) {
    const auto key = static_cast<Key>(i);
    CHECK(find_key(name_of(key)) == key);
    CHECK(names.insert(name_of(key)).second);
  }
  CHECK(find_key("f12") == Key::f12);
  CHECK_FALSE(find_key("").has_value());
  CHECK_FALSE(find_key("F13").has_value());
}

TEST_CASE("a chord reads back from its text", "[client_input]") {
  const KeyChord chord{Key::z, true, true, false};
  CHECK(text_of(chord) == "ctrl+shift+Z");
  CHECK(parse_key_chord("ctrl+shift+Z") == chord);
  CHECK(parse_key_chord("CTRL+z") == KeyChord{Key::z, true, false, false});
  CHECK_FALSE(parse_key_chord("ctrl+").has_value());
  CHECK_FALSE(parse_key_chord("super+Z").has_value());
}

TEST_CASE("no two default actions share a key, and every action has one", "[client_input]") {
  const KeyMap keys;
  std::set<std::string> texts;
  std::set<std::string_view> names;
  for (const ActionInfo& row : action_table()) {
    CHECK_FALSE(keys.keys_of(row.action).empty());
    CHECK(names.insert(row.name).second);
    for (const KeyChord& chord : keys.keys_of(row.action)) {
      CAPTURE(text_of(chord));
      CHECK(texts.insert(text_of(chord)).second);
    }
  }
}

TEST_CASE("control belongs to a chord, and shift only where a chord names it", "[client_input]") {
  const KeyMap keys;
  CHECK(keys.pressed(press(Key::z, true)) == Action::undo);
  CHECK(keys.pressed(press(Key::z, true, true)) == Action::redo);
  CHECK(keys.pressed(press(Key::y, true)) == Action::redo);
  CHECK_FALSE(keys.pressed(press(Key::z)).has_value());
  CHECK(keys.pressed(press(Key::t)) == Action::chat);
  CHECK(keys.pressed(press(Key::t, false, true)) == Action::chat);
  CHECK_FALSE(keys.pressed(press(Key::t, true)).has_value());
  CHECK(keys.held(Key::w) == Action::move_forward);
}

TEST_CASE("a key that is bound anew leaves its old action", "[client_input]") {
  KeyMap keys;
  keys.bind(Action::palette, {{Key::t}});
  CHECK(keys.pressed(press(Key::t)) == Action::palette);
  CHECK(keys.keys_text(Action::palette) == "T");
  CHECK(keys.keys_text(Action::chat) == "enter");
  CHECK_FALSE(keys.pressed(press(Key::e)).has_value());
}

TEST_CASE("a held action takes its key with shift, too", "[client_input]") {
  KeyMap keys;
  keys.bind(Action::move_forward, {{Key::w}, {Key::up}});
  CHECK_FALSE(keys.pressed(press(Key::up)).has_value());
  CHECK_FALSE(keys.pressed(press(Key::up, false, true)).has_value());
  CHECK(keys.keys_of(Action::nudge_up).empty());
  CHECK(keys.pressed(press(Key::down, false, true)) == Action::nudge_down);
  // Without a held action, shift makes another chord.
  keys.bind(Action::palette, {{Key::down}});
  CHECK(keys.pressed(press(Key::down)) == Action::palette);
  CHECK(keys.pressed(press(Key::down, false, true)) == Action::nudge_down);
}
