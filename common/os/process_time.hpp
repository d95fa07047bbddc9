// The processor time of this process.
#pragma once
#include <sys/resource.h>

namespace runstone {

struct ProcessTime {
  double user_s = 0, system_s = 0;
  ProcessTime operator-(const ProcessTime& since) const {
    return {user_s - since.user_s, system_s - since.system_s};
  }
};

/// Returns the time of all threads since the start of the process.
inline ProcessTime process_time() {
  rusage use{};
  ::getrusage(RUSAGE_SELF, &use);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) / 1e6;
  };
  return {seconds(use.ru_utime), seconds(use.ru_stime)};
}

}  // namespace runstone
