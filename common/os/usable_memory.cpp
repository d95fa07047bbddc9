#include "common/os/usable_memory.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace runstone {
namespace {

/// Returns the path of the process's control group below the mount point, such as "/user.slice", or
/// nullopt without cgroup v2.
std::optional<std::filesystem::path> control_group() {
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    constexpr std::string_view kVersion2 = "0::/";
    if (line.starts_with(kVersion2)) return line.substr(kVersion2.size());
  }
  return std::nullopt;
}

/// Returns the limits of the group and of those that contain it, a line each.
std::string limits() {
  const auto group = control_group();
  if (!group) return {};
  std::ostringstream out;
  std::filesystem::path folder = "/sys/fs/cgroup";
  const auto read = [&] { out << std::ifstream(folder / "memory.max").rdbuf() << '\n'; };
  read();
  for (const auto& part : *group) {
    folder /= part;
    out.clear();  // a group without the file sets the stream's failbit
    read();
  }
  return out.str();
}

}  // namespace

std::optional<std::uint64_t> memory_limit_of(const std::string& text) {
  std::optional<std::uint64_t> least;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::uint64_t bytes = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), bytes);
    if (error != std::errc{} || end != line.data() + line.size()) continue;
    least = std::min(least.value_or(bytes), bytes);
  }
  return least;
}

std::optional<std::uint64_t> usable_memory_bytes() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
  const auto limit = memory_limit_of(limits());
  if (pages <= 0 || page <= 0) return limit;
  const std::uint64_t all = static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page);
  return std::min(limit.value_or(all), all);
}

}  // namespace runstone
