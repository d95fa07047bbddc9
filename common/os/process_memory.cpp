#include "common/os/process_memory.hpp"

#include <unistd.h>

#include <fstream>

namespace runstone {

std::uint64_t process_memory_bytes() {
  // Pages of the whole process and pages in RAM (proc(5)).
  std::ifstream in("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  const long page_bytes = ::sysconf(_SC_PAGESIZE);
  if (!(in >> all >> resident) || page_bytes <= 0) return 0;
  return resident * static_cast<std::uint64_t>(page_bytes);
}

}  // namespace runstone
