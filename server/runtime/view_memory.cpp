#include "server/runtime/view_memory.hpp"

namespace runstone {
namespace {

// An entry has 8 bytes. While the order of a view changes there is a second list, of 12 bytes an
// entry, which is freed afterwards; the allocator keeps about half of it.
constexpr std::size_t kBytesPerChunk = 14;

constexpr std::uint64_t kMib = 1 << 20;

}  // namespace

std::size_t view_bytes(std::uint64_t radius) {
  std::uint64_t columns = 0;
  std::uint64_t z = radius;
  for (std::uint64_t x = 0; x <= radius; ++x) {
    while (x * x + z * z > radius * radius) --z;
    columns += (x == 0 ? 1 : 2) * (2 * z + 1);
  }
  return static_cast<std::size_t>(columns * (2 * radius + 1)) * kBytesPerChunk;
}

std::optional<std::string> view_memory_warning(const ServerConfig& config) {
  const std::uint64_t of_session = view_bytes(config.view_radius_max);
  const std::uint64_t all_mib = of_session * config.sessions_max / kMib;
  if (all_mib <= config.memory_mib) return std::nullopt;
  return "view_radius_max = " + std::to_string(config.view_radius_max) +
         ": a session that sees so far takes about " +
         std::to_string((of_session + kMib / 2) / kMib) +
         " MiB, and sessions_max = " + std::to_string(config.sessions_max) + " of them " +
         std::to_string(all_mib) +
         " MiB, beside memory_mib = " + std::to_string(config.memory_mib) +
         ": lower view_radius_max or sessions_max, or give roles a smaller view (role set NAME "
         "RIGHTS view N), unless the machine has so much";
}

}  // namespace runstone
