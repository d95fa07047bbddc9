// The thesis' question: on which links is compressed transfer plus RDM faster, and by how much?
// Each scene (the 37 scenarios as 27 chunks, and 64 chunks of each world) is sent in each form over
// each link, on a fresh TCP connection. The receiver unpacks and meshes chunks as they arrive.
// Encoding is not in the time, because a server does it once.
#pragma once
#include "bench/network/testbed.hpp"

namespace runstone::bench {

Done measure_transfers(Testbed& testbed, NetFindings& findings);

}  // namespace runstone::bench
