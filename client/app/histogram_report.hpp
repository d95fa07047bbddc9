// How a fleet's report shows a histogram of durations in microseconds.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "client/schedule/histogram.hpp"

namespace runstone {

/// {"count", "infinite", "below_zero", "mean", "p50", "p90", "p99", "p99_9", "max", "up_to": [[us, count], ...]}: microseconds; "infinite" in place of
/// a number for what never came, and null where nothing was counted. `up_to` has how many durations lie above the limit before
/// and not above this one, which doubles from row to row; empty rows are left out.
nlohmann::ordered_json histogram_json(const Histogram& us);
/// "what, ms: p50 1.20 p90 3.40 p99 5.60 p99.9 7.80 max 9.10, 2000 counted" and a line end.
std::string histogram_line(std::string_view what, const Histogram& us);
/// The rows of `up_to` as lines with bars.
std::string histogram_picture(const Histogram& us);

}  // namespace runstone
