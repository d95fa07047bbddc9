// The horizon: how soon a client that joins a world which nobody has visited sees distant ground,
// and how many bytes it receives.
#pragma once
#include "bench/network/testbed.hpp"

namespace runstone::bench {

/// Measures first joins over each link. The client has a view radius of 8 chunks, and 0, 4 or 6
/// levels of tiles: it sees 256, 4,096 or 16,384 voxels far; with --quick it sees 96, 192 and 384.
/// Each join has a server and a world of its own.
Done measure_horizon(Testbed& testbed, NetFindings& findings);

}  // namespace runstone::bench
