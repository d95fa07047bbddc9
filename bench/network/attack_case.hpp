// Attacks: bots in one place edit on loopback while hostile clients attack the same server.
// Measured are the latency of the bots' edits before, during and after the attack, the server's
// answers to the attackers, its memory, processor time and disk, and the time of a stop while an
// attack goes on.
#pragma once
#include "bench/network/testbed.hpp"

namespace runstone::bench {

Done measure_attacks(Testbed& testbed, NetFindings& findings);

}  // namespace runstone::bench
