#include "common/os/free_space.hpp"

#include <sys/statvfs.h>

namespace runstone {

std::optional<std::uint64_t> free_bytes(const std::string& path) {
  struct statvfs found{};
  if (::statvfs(path.c_str(), &found) != 0) return std::nullopt;
  return std::uint64_t{found.f_bavail} * found.f_frsize;
}

}  // namespace runstone
