// The client's one clock: steady, so that differences are durations. Any thread.
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

}  // namespace runstone
