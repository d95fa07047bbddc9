// The time service of the machine.
#pragma once
#include <sys/timex.h>

#include <optional>

namespace runstone {

/// Returns true if the kernel reports that a time service has set the wall clock and keeps it right.
/// Returns nullopt if the kernel reports nothing, for example in a sandbox. Thread: any. Cost: one call
/// of the system.
inline std::optional<bool> is_clock_synchronised() {
  struct timex about{};  // modes 0: nothing is changed
  if (::adjtimex(&about) < 0) return std::nullopt;
  return (about.status & STA_UNSYNC) == 0;
}

}  // namespace runstone
