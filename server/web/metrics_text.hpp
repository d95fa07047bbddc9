// The metrics page, for Prometheus.
#pragma once
#include <span>
#include <string>

#include "server/web/server_status.hpp"
#include "server/web/web_counters.hpp"

namespace runstone {

/// Returns the counters of server and gateway in the text format of Prometheus, version 0.0.4. They
/// are named runstone_NAME, as in the server's line of counters, and runstone_web_NAME, and have
/// help and a type (metric_kinds.hpp). Counters that only a later server has are untyped.
/// runstone_up is 1 if the server has answered and 0 if not; the server's counters are then left
/// out. Those of several servers have the label `world`.
std::string metrics_text(std::span<const WorldStatus> worlds, const WebCounters& web);

}  // namespace runstone
