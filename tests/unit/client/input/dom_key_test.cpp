#include "client/input/dom_key.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <string>

using namespace runstone;

TEST_CASE("the names of a browser lead to the keys of the key map", "[input]") {
  CHECK(key_of_code("KeyW") == Key::w);
  CHECK(key_of_code("KeyA") == Key::a);
  CHECK(key_of_code("KeyZ") == Key::z);
  CHECK(key_of_code("Digit0") == Key::digit_0);
  CHECK(key_of_code("Digit9") == Key::digit_9);
  CHECK(key_of_code("F1") == Key::f1);
  CHECK(key_of_code("F12") == Key::f12);
  CHECK(key_of_code("Escape") == Key::escape);
  CHECK(key_of_code("ArrowLeft") == Key::left);
  CHECK(key_of_code("ShiftLeft") == Key::left_shift);
  CHECK(key_of_code("Space") == Key::space);
}

TEST_CASE("names that no key has are no keys", "[input]") {
  for (const char* code : {"", "Key", "KeyAB", "Key!", "Digit", "Digit10", "F", "F13", "F0", "f1",
                           "W", "IntlBackslash", "MediaPlayPause", "keyW"}) {
    CAPTURE(code);
    CHECK(key_of_code(code) == Key::unknown);
  }
}

TEST_CASE("every key but the unknown one has a name in a browser", "[input]") {
  std::set<Key> reached;
  for (char c = 'A'; c <= 'Z'; ++c) reached.insert(key_of_code(std::string("Key") + c));
  for (char c = '0'; c <= '9'; ++c) reached.insert(key_of_code(std::string("Digit") + c));
  for (int i = 1; i <= 12; ++i) reached.insert(key_of_code("F" + std::to_string(i)));
  for (const char* code :
       {"Escape",       "Enter",      "Tab",      "Backspace", "Insert",     "Delete",
        "ArrowLeft",    "ArrowRight", "ArrowUp",  "ArrowDown", "PageUp",     "PageDown",
        "Home",         "End",        "Space",    "ShiftLeft", "ShiftRight", "ControlLeft",
        "ControlRight", "AltLeft",    "AltRight", "Minus",     "Equal",      "BracketLeft",
        "BracketRight", "Comma",      "Period",   "Slash",     "NumpadEnter"})
    reached.insert(key_of_code(code));
  CHECK(reached.size() == kKeyCount - 1);
  CHECK_FALSE(reached.contains(Key::unknown));
}

TEST_CASE("a letter counts by the user's layout, other keys by their place", "[input]") {
  CHECK(key_of_text("z", Key::y) == Key::z);  // a German keyboard
  CHECK(key_of_text("Z", Key::y) == Key::z);
  CHECK(key_of_text("1", Key::digit_1) == Key::digit_1);
  CHECK(key_of_text("&", Key::digit_1) == Key::digit_1);  // a French keyboard
  CHECK(key_of_text("Shift", Key::left_shift) == Key::left_shift);
  CHECK(key_of_text("ö", Key::unknown) == Key::unknown);
  CHECK(key_of_text("", Key::w) == Key::w);
}
