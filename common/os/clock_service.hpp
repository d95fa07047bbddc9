// The time service of the machine.
#pragma once
#include <sys/timex.h>

#include <optional>

namespace runstone {

/// Returns true if a time service has set the wall clock and keeps it right, as the kernel knows.
/// Returns nullopt if the kernel does not say, for example in a sandbox.
inline std::optional<bool> is_clock_synchronised() {
  struct timex about{};  // modes 0: nothing is changed
  if (::adjtimex(&about) < 0) return std::nullopt;
  return (about.status & STA_UNSYNC) == 0;
}

}  // namespace runstone
