// Joins: the time until a joining client has the world around it: from the start of the connection
// until 80 % and all of the chunks are meshed, of the near view (within 3 chunks) and of the whole
// view (6 chunks horizontally, 3 vertically). The world is the imported one, the server has its
// chunks in memory, and the client is new each time.
#pragma once
#include "bench/network/testbed.hpp"

namespace runstone::bench {

Done measure_joins(Testbed& testbed, NetFindings& findings);

}  // namespace runstone::bench
