// How soon a client that joins has a picture: from when it begins to connect until 80 % and all of the chunks around it
// are meshed, of the near view (within 3 chunks) and of the whole (6 chunks horizontally, 3 vertically). The world is
// the imported one, the server has its chunks in memory, the client is new each time.
#pragma once
#include "tests/bench/network/lab.hpp"

namespace runstone::bench {

Done measure_joins(Lab& lab, LabFindings& findings);

}  // namespace runstone::bench
