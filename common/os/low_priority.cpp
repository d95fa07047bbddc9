#include "common/os/low_priority.hpp"

#include <algorithm>

#ifdef __linux__
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace runstone {

void lower_priority() {
#ifdef __linux__
  constexpr int kNice = 10;
  const auto self = static_cast<id_t>(::gettid());
  static_cast<void>(
      ::setpriority(PRIO_PROCESS, self, std::max(kNice, ::getpriority(PRIO_PROCESS, self))));
#endif
}

void lower_disk_priority() {
#ifdef __linux__
  // The C library has no function and no header for them (ioprio_set(2)).
  constexpr int kWhoProcess = 1, kClassBestEffort = 2, kClassShift = 13, kLowest = 7;
  static_cast<void>(
      ::syscall(SYS_ioprio_set, kWhoProcess, 0, kClassBestEffort << kClassShift | kLowest));
#endif
}

}  // namespace runstone
