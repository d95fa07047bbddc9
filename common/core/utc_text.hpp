// Points in time and durations as text, in the form that people read and type. Times are UTC. No
// clock is read and no locale is used.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "common/core/ids.hpp"

namespace runstone {

/// Returns text such as "2026-11-21T23:57:42Z", rounded down to the second.
std::string utc_text(TimeUs utc_us);

/// Parses text such as "2026-11-21T23:57:42.25Z" to microseconds since 1970. The Z, the decimals
/// (six at most), the seconds and the time of day are optional. Years are 1970 .. 9999. Returns
/// nullopt on any other text.
std::optional<TimeUs> parse_utc(std::string_view text);

/// Parses a duration such as "90s", "15m", "2h30m" or "1w2d" to microseconds. Each number has at
/// most six digits and is followed by its unit w, d, h, m or s. Each unit occurs at most once, the
/// longest first. Returns nullopt on any other text.
std::optional<TimeUs> parse_duration(std::string_view text);

}  // namespace runstone
