// How a fleet's report shows a histogram of durations in microseconds.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "client/schedule/histogram.hpp"

namespace runstone {

/// {"count", "infinite", "below_zero", "mean", "p50", "p90", "p99", "p99_9", "max", "rows": [[from, below, count], ...]}:
/// microseconds; "infinite" in place of a number for what never came, and null where nothing was counted. `rows` as of
/// Histogram::rows(): with `infinite` they add up to `count`.
nlohmann::ordered_json histogram_json(const Histogram& us);
/// "what, ms: p50 1.20 p90 3.40 p99 5.60 p99.9 7.80 max 9.10, 2000 counted" and a line end.
std::string histogram_line(std::string_view what, const Histogram& us);
/// The rows as lines with bars.
std::string histogram_picture(const Histogram& us);

}  // namespace runstone
