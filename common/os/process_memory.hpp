// The memory of the calling process.
#pragma once
#include <cstdint>

namespace runstone {

/// Returns the bytes of memory that the process has in RAM, or 0 if the system does not tell.
std::uint64_t process_memory_bytes();

}  // namespace runstone
