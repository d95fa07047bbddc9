// SiegeResult: what was measured in a siege, window by window.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "bench/network/fleet.hpp"

namespace runstone::bench {

struct SiegeWindow {
  double from_s = 0, to_s = 0;  // since the server started
  std::string attack;           // kQuiet: nobody attacks
  FleetReport seen;             // by the builders
  double resident_mb = 0;       // of the server, the highest
  double disk_kb_s = 0;         // written by the server
};

struct SiegeResult {
  std::vector<SiegeWindow> windows;
  double resident_max_mb = 0;  // in all windows and while the server stops
  double stop_s = 0;           // from SIGTERM, without an attack, to the end of the server
  std::uint64_t errors = 0;    // lines of level error in the server's log
};

}  // namespace runstone::bench
