// Fleets: 1 to 1,000 bots in one place on loopback, all subscribed to the same chunks, with 2 edits
// a second each at fixed times. Measured are the latency of edits for every bot that sees them, the
// bytes that a client receives, and the server's processor time. No sample is dropped.
#pragma once
#include "bench/network/testbed.hpp"

namespace runstone::bench {

Done measure_fleets(Testbed& testbed, NetFindings& findings);

}  // namespace runstone::bench
