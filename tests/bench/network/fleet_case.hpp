// Crowds: 1 to 1,000 bots in one place on loopback, all subscribed to the same chunks, each with 2 edits a second, open
// loop: how late edits are for everybody who sees them, what a client receives, and what the server alone needs of the
// cores. No sample is dropped.
#pragma once
#include "tests/bench/network/lab.hpp"

namespace runstone::bench {

Done measure_fleets(Lab& lab, LabFindings& findings);

}  // namespace runstone::bench
