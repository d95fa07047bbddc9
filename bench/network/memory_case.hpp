// Memory: the growth of a server's resident set while it loads 10,000 chunks of the real world,
// divided by the chunks. The imported world is smaller and is repeated side by side until it is
// large enough; no two copies share memory. One client loads all of it and leaves. The empty chunks
// around the copies are loaded too. A server with nothing but empty chunks shows their cost.
#pragma once
#include "bench/network/testbed.hpp"

namespace runstone::bench {

Done measure_memory(Testbed& testbed, NetFindings& findings);

}  // namespace runstone::bench
