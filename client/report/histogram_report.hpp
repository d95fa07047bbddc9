// Histograms of durations, in microseconds, in the report of a fleet.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "client/schedule/histogram.hpp"

namespace runstone {

/// Returns {"count", "infinite", "below_zero", "mean", "p50", "p90", "p99", "p99_9", "max", "rows":
/// [[from, below, count], ...]}, durations in microseconds. An infinite value is the word
/// "infinite", and a value of an empty histogram is null. `rows` are those of Histogram::rows();
/// with `infinite` they add up to `count`.
nlohmann::ordered_json histogram_json(const Histogram& us);
/// Returns a line such as "what, ms: p50 1.20 p90 3.40 p99 5.60 p99.9 7.80 max 9.10, 2000
/// counted\n".
std::string histogram_line(std::string_view what, const Histogram& us);
/// Returns a line with a bar for each row.
std::string histogram_bars(const Histogram& us);

}  // namespace runstone
