// ScriptWords: the words of a line of a script, and functions that read numbers and places from
// them. Internal to the parser.
#pragma once
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "client/script/script.hpp"

namespace runstone {

/// An error in a line. It is thrown and caught by the parser only.
struct LineError {
  std::string what;
};

class ScriptWords {
 public:
  explicit ScriptWords(std::string_view line) : line_(line) {
    std::size_t at = 0;
    while (at < line.size()) {
      const std::size_t first = line.find_first_not_of(" \t\r", at);
      if (first == std::string_view::npos || line[first] == '#') break;
      const std::size_t last = std::min(line.find_first_of(" \t\r", first), line.size());
      words_.push_back(line.substr(first, last - first));
      at = last;
    }
  }
  bool more() const { return next_ < words_.size(); }
  bool empty() const { return words_.empty(); }
  /// Returns the next word without taking it, or an empty text if there is none.
  std::string_view peek() const { return more() ? words_[next_] : std::string_view{}; }
  /// Takes the next word. Throws LineError if there is none; `what` says what was expected.
  std::string_view word(const char* what) {
    if (!more()) throw LineError{std::string("expected ") + what};
    return words_[next_++];
  }
  /// Takes the rest of the line after the last word taken, including comments.
  std::string_view rest() {
    const std::size_t first =
        next_ == 0 ? 0
                   : static_cast<std::size_t>(words_[next_ - 1].data() - line_.data()) +
                         words_[next_ - 1].size();
    std::string_view text = line_.substr(first);
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r"), text.size()));
    text = text.substr(0, text.find_last_not_of(" \t\r") + 1);
    next_ = words_.size();
    return text;
  }
  void finish() const {
    if (more()) throw LineError{"unexpected \"" + std::string(words_[next_]) + "\""};
  }

 private:
  std::string_view line_;
  std::vector<std::string_view> words_;
  std::size_t next_ = 0;
};

template <class T>
std::optional<T> to_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) return std::nullopt;
  }
  return value;
}

template <class T>
T read_number(ScriptWords& words, const char* what, T low, T high) {
  const std::string_view text = words.word(what);
  const auto value = to_number<T>(text);
  if (!value || *value < low || *value > high) {
    throw LineError{std::string(what) + ": \"" + std::string(text) +
                    "\" is not a number in its range"};
  }
  return *value;
}

/// Takes the coordinates of a place.
ScriptPosition read_position(ScriptWords& words);

/// Takes x, y or z.
Axis read_axis(ScriptWords& words);

/// Takes on or off.
bool read_on_off(ScriptWords& words);

/// Takes a material.
std::string read_material(ScriptWords& words);

}  // namespace runstone
