// Moments as people read and type them: UTC, by the calendar. No clock and no locale in it.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "common/core/ids.hpp"

namespace runstone {

/// "2026-11-21T23:57:42Z", to the second (rounded down).
std::string utc_text(TimeUs utc_us);

/// Microseconds since 1970 of "2026-11-21T23:57:42.25Z"; the Z may be missing, and the decimals (six at most), the seconds and the
/// time of day. Years 1970 .. 9999. Nothing if it is no such moment.
std::optional<TimeUs> parse_utc(std::string_view text);

/// Microseconds of "90s", "15m", "2h30m", "1w2d": numbers of at most six digits, each with its unit w, d, h, m or s; each unit
/// at most once, the longest first. Nothing otherwise.
std::optional<TimeUs> parse_duration(std::string_view text);

}  // namespace runstone
