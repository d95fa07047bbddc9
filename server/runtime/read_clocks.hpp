// read_clocks(): reads the clocks for the world strand, which itself reads none.
#pragma once
#include <chrono>

#include "common/os/steady_clock.hpp"
#include "server/world/environment/clocks.hpp"

namespace runstone {

/// Thread: any.
inline Clocks read_clocks() {
  const auto utc = std::chrono::system_clock::now().time_since_epoch();
  return {steady_now_us(), std::chrono::duration_cast<std::chrono::microseconds>(utc).count()};
}

}  // namespace runstone
