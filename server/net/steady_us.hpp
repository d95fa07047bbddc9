// The server's steady clock, for differences only. Any thread.
#pragma once
#include <chrono>

#include "common/core/ids.hpp"

namespace runstone {

inline TimeUs steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace runstone
