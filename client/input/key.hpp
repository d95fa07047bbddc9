// Key: a key of the keyboard, with a name for documents and settings. KeyChord: a key together with
// modifiers, such as ctrl+Z.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace runstone {

// clang-format off
enum class Key : std::uint8_t {
  unknown,
  a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z,
  digit_0, digit_1, digit_2, digit_3, digit_4, digit_5, digit_6, digit_7, digit_8, digit_9,
  f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12,
  escape, enter, tab, backspace, insert, delete_forward, left, right, up, down, page_up, page_down,
  home, end, space, left_shift, right_shift, left_control, right_control, left_alt, right_alt,
  minus, equal, left_bracket, right_bracket, comma, period, slash, keypad_enter,
};
// clang-format on
inline constexpr std::size_t kKeyCount = static_cast<std::size_t>(Key::keypad_enter) + 1;

/// Returns the name as in documents and settings: "A", "1", "F2", "escape", "[".
std::string_view name_of(Key key);
/// Returns the key with this name, in any case of letters, or nullopt if there is none.
std::optional<Key> find_key(std::string_view name);

struct KeyChord {
  Key key = Key::unknown;
  bool control = false, shift = false, alt = false;
  friend bool operator==(const KeyChord&, const KeyChord&) = default;
};

/// Returns the chord as in documents and settings: "ctrl+Z", "ctrl+shift+Z", "F1".
std::string text_of(const KeyChord& chord);
/// Reads the form of text_of(), in any case of letters. Returns nullopt if the text is no chord.
std::optional<KeyChord> parse_key_chord(std::string_view text);

}  // namespace runstone
