// The clocks of the benchmarks.
#pragma once
#include <cstdint>

namespace runstone::bench {

/// Returns the time of a monotonic clock, in ns.
std::uint64_t now_ns();

/// Returns the processor time of this thread, in ns. Time in which other threads have the core does
/// not count. Cost: a system call.
std::uint64_t core_ns();

}  // namespace runstone::bench
