// Memory: what a server's resident set grows by while it loads 10,000 chunks of the real world, a chunk. The imported
// world, which is smaller, is laid side by side until it is large enough; no two copies share memory. One client asks for
// all of it and leaves. What is around the copies is empty and is loaded too; what that takes, a server with nothing but
// empty chunks tells.
#pragma once
#include "tests/bench/network/lab.hpp"

namespace runstone::bench {

Done measure_memory(Lab& lab, LabFindings& findings);

}  // namespace runstone::bench
