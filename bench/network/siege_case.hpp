// Siege: a crowd of builders edits in one place for ten minutes, while all attacks take turns
// against the same server. Measured are the latency of the builders' edits, the server's memory and
// disk in windows of ten seconds, and the time of the stop.
#pragma once
#include "bench/network/testbed.hpp"

namespace runstone::bench {

Done measure_siege(Testbed& testbed, NetFindings& findings);

}  // namespace runstone::bench
