// The clock since the machine was started. In contrast to that of steady_clock.hpp it goes on while
// the machine is suspended. So it measures what runs out elsewhere meanwhile, such as a lease.
// Thread: any.
#pragma once
#include <time.h>

#include "common/core/ids.hpp"

namespace runstone {

inline TimeUs boot_now_us() {
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<TimeUs>(now.tv_sec) * 1'000'000 + now.tv_nsec / 1'000;
}

}  // namespace runstone
