// How long bots waited for their own edits, from due to confirmed, in a fleet's report.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "client/schedule/histogram.hpp"

namespace runstone {

/// {"p50", "p90", "p99", "max"}, microseconds; 0 where nothing was confirmed.
nlohmann::ordered_json own_latency_json(const Histogram& own_us);
/// The same in milliseconds, as a line.
std::string own_latency_line(const Histogram& own_us);

}  // namespace runstone
