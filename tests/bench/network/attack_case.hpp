// Attacks: bots in one place edit on loopback while hostile clients do their worst to the same server: how late edits are for the
// bots before, during and after, what the server says to the attackers, and what it needs of memory and cores.
#pragma once
#include "tests/bench/network/lab.hpp"

namespace runstone::bench {

Done measure_attacks(Lab& lab, LabFindings& findings);

}  // namespace runstone::bench
