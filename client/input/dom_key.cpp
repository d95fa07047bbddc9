#include "client/input/dom_key.hpp"

#include <optional>
#include <utility>

namespace runstone {
namespace {

constexpr std::pair<std::string_view, Key> kCodes[] = {
    {"Escape", Key::escape},
    {"Enter", Key::enter},
    {"Tab", Key::tab},
    {"Backspace", Key::backspace},
    {"Insert", Key::insert},
    {"Delete", Key::delete_forward},
    {"ArrowLeft", Key::left},
    {"ArrowRight", Key::right},
    {"ArrowUp", Key::up},
    {"ArrowDown", Key::down},
    {"PageUp", Key::page_up},
    {"PageDown", Key::page_down},
    {"Home", Key::home},
    {"End", Key::end},
    {"Space", Key::space},
    {"ShiftLeft", Key::left_shift},
    {"ShiftRight", Key::right_shift},
    {"ControlLeft", Key::left_control},
    {"ControlRight", Key::right_control},
    {"AltLeft", Key::left_alt},
    {"AltRight", Key::right_alt},
    {"Minus", Key::minus},
    {"Equal", Key::equal},
    {"BracketLeft", Key::left_bracket},
    {"BracketRight", Key::right_bracket},
    {"Comma", Key::comma},
    {"Period", Key::period},
    {"Slash", Key::slash},
    {"NumpadDivide", Key::slash},
    {"NumpadEnter", Key::keypad_enter},
};

Key key_after(Key first, int steps) { return static_cast<Key>(static_cast<int>(first) + steps); }

std::optional<Key> letter_or_digit(char c) {
  if (c >= 'a' && c <= 'z') return key_after(Key::a, c - 'a');
  if (c >= 'A' && c <= 'Z') return key_after(Key::a, c - 'A');
  if (c >= '0' && c <= '9') return key_after(Key::digit_0, c - '0');
  return std::nullopt;
}

}  // namespace

Key key_of_code(std::string_view code) {
  constexpr std::string_view kLetter = "Key", kDigit = "Digit";
  if (code.size() == kLetter.size() + 1 && code.starts_with(kLetter))
    return letter_or_digit(code.back()).value_or(Key::unknown);
  if (code.size() == kDigit.size() + 1 && code.starts_with(kDigit))
    return letter_or_digit(code.back()).value_or(Key::unknown);
  for (const auto& [name, key] : kCodes) {
    if (name == code) return key;
  }
  // The names F1 to F12 are those of documents and settings, too.
  const auto function = code.starts_with("F") ? find_key(code) : std::nullopt;
  return function && *function >= Key::f1 && *function <= Key::f12 ? *function : Key::unknown;
}

Key key_of_text(std::string_view text, Key place) {
  return text.size() == 1 ? letter_or_digit(text.front()).value_or(place) : place;
}

}  // namespace runstone
