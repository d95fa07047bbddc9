// The text of a time of day, "HH" or "HH:MM", as a share of the day.
#pragma once
#include <optional>
#include <string_view>

namespace runstone {

/// Returns the share of the day that has passed at that time, 0 (midnight) .. below 1, or nullopt
/// if the text is no time from 0:00 to 23:59.
constexpr std::optional<double> parse_day_time(std::string_view text) {
  const std::size_t colon = text.find(':');
  const auto number = [](std::string_view digits, int below) -> std::optional<int> {
    if (digits.empty() || digits.size() > 2) return std::nullopt;
    int value = 0;
    for (const char c : digits) {
      if (c < '0' || c > '9') return std::nullopt;
      value = 10 * value + (c - '0');
    }
    return value < below ? std::optional(value) : std::nullopt;
  };
  const auto hours = number(text.substr(0, colon), 24);
  const auto minutes =
      colon == std::string_view::npos ? std::optional(0) : number(text.substr(colon + 1), 60);
  if (!hours || !minutes) return std::nullopt;
  return (*hours * 60 + *minutes) / 1440.0;
}

}  // namespace runstone
