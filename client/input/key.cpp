#include "client/input/key.hpp"

#include <array>

namespace runstone {
namespace {

// clang-format off
constexpr std::array<std::string_view, kKeyCount> kNames = {
    "unknown",
    "A", "B", "C", "D", "E", "F", "G", "H", "I", "J", "K", "L", "M", "N", "O", "P", "Q", "R", "S",
    "T", "U", "V", "W", "X", "Y", "Z",
    "0", "1", "2", "3", "4", "5", "6", "7", "8", "9",
    "F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F9", "F10", "F11", "F12",
    "escape", "enter", "tab", "backspace", "insert", "delete", "left", "right", "up", "down",
    "page_up", "page_down", "home", "end", "space", "shift", "right_shift", "control",
    "right_control", "alt", "right_alt",
    "minus", "equal", "[", "]", "comma", "period", "slash", "keypad_enter",
};
// clang-format on

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool same_name(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (lower(a[i]) != lower(b[i])) return false;
  }
  return true;
}

/// Takes a modifier such as "ctrl+" from the front of the text. Returns true if it was there.
bool take_modifier(std::string_view& text, std::string_view modifier) {
  if (text.size() <= modifier.size() || !same_name(text.substr(0, modifier.size()), modifier))
    return false;
  text.remove_prefix(modifier.size());
  return true;
}

}  // namespace

std::string_view name_of(Key key) { return kNames[static_cast<std::size_t>(key)]; }

std::optional<Key> find_key(std::string_view name) {
  for (std::size_t i = 1; i < kKeyCount; ++i) {
    if (same_name(kNames[i], name)) return static_cast<Key>(i);
  }
  return std::nullopt;
}

std::string text_of(const KeyChord& chord) {
  std::string text;
  if (chord.control) text += "ctrl+";
  if (chord.shift) text += "shift+";
  if (chord.alt) text += "alt+";
  return text + std::string(name_of(chord.key));
}

std::optional<KeyChord> parse_key_chord(std::string_view text) {
  KeyChord chord;
  chord.control = take_modifier(text, "ctrl+");
  chord.shift = take_modifier(text, "shift+");
  chord.alt = take_modifier(text, "alt+");
  const auto key = find_key(text);
  if (!key) return std::nullopt;
  chord.key = *key;
  return chord;
}

}  // namespace runstone
