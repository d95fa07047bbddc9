// The clock of a program for durations. It never goes back, and its zero has no meaning. Thread:
// any.
#pragma once
#include <chrono>
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

inline std::int64_t steady_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}
inline TimeUs steady_now_us() { return steady_now_ns() / 1000; }

inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace runstone
