// The metrics of a server: what each counter of its status means, and of which type it is.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace runstone {

enum class CounterType : std::uint8_t {
  counter,  // only grows, and begins at 0 with the server
  gauge     // may fall
};

struct MetricKind {
  std::string_view name;  // of the counter: the metric is runstone_NAME
  CounterType type = CounterType::counter;
  const char* help = "";
};

/// Returns the counters that this version of the server has, but for those of histograms.
std::span<const MetricKind> metric_kinds();
/// Returns the row of a counter, or null: a later server may have more of them. Cost: O(rows).
const MetricKind* find_metric_kind(std::string_view counter);

/// A histogram of how long edits waited. The counters NAME_count, NAME_us and NAME_ms_le_N are its
/// parts, and the metric is runstone_NAME_seconds.
struct WaitMetric {
  std::string_view name;
  const char* help = "";
};
std::span<const WaitMetric> wait_metrics();
/// Returns true if the counter is a part of one of the histograms.
bool is_part_of_waits(std::string_view counter);

}  // namespace runstone
