// A program's one clock for durations: steady, so that it never goes back; what it counts from means nothing. Any thread.
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
