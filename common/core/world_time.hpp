// WorldTime: the time of day of a world, and how fast it runs. Whole numbers, so that every program
// that knows the time of a world and how long ago it had it comes to the same result.
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/core/day_time.hpp"
#include "common/core/ids.hpp"

namespace runstone {

inline constexpr std::uint32_t kDayMs = 86'400'000;
/// At the greatest rate, a day of the world takes 8.64 s.
inline constexpr std::uint32_t kTimeRateMax = 10'000;

struct WorldTime {
  std::uint32_t day_ms = 0;  // milliseconds since midnight, below kDayMs
  std::uint32_t rate =
      0;  // seconds of the world in a second, 0 .. kTimeRateMax; 0: it stands still
  friend bool operator==(const WorldTime&, const WorldTime&) = default;
};

constexpr bool is_valid(const WorldTime& time) {
  return time.day_ms < kDayMs && time.rate <= kTimeRateMax;
}

/// Returns the time after `elapsed_us` of a steady clock; fewer than 0 count as 0. Requires
/// is_valid(). The result is valid.
constexpr WorldTime later(const WorldTime& time, TimeUs elapsed_us) {
  constexpr TimeUs kDayUs = TimeUs{kDayMs} * 1000;
  if (elapsed_us <= 0) return time;
  // Whole days of the steady clock are whole days of the world. The product is below 2^50.
  const TimeUs passed_us = elapsed_us % kDayUs * time.rate % kDayUs;
  return {static_cast<std::uint32_t>((time.day_ms + passed_us / 1000) % kDayMs), time.rate};
}

/// Returns the share of the day that has passed, 0 (midnight) .. below 1.
constexpr double day_share(const WorldTime& time) { return time.day_ms / double{kDayMs}; }

/// Returns the milliseconds since midnight of a text "HH" or "HH:MM", or nullopt if it is no time
/// from 0:00 to 23:59.
inline std::optional<std::uint32_t> parse_day_ms(std::string_view text) {
  const auto share = parse_day_time(text);
  if (!share) return std::nullopt;
  return static_cast<std::uint32_t>(std::llround(*share * kDayMs));
}

/// Returns the hours and minutes of a time, such as "21:05".
inline std::string day_time_text(std::uint32_t day_ms) {
  const std::uint32_t minutes = day_ms / 60'000 % 1440;
  const std::string minute = std::to_string(minutes % 60);
  return std::to_string(minutes / 60) + (minute.size() == 1 ? ":0" : ":") + minute;
}

}  // namespace runstone
