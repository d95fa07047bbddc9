#include "server/runtime/disk_usage.hpp"

#include <filesystem>

#include "common/os/free_space.hpp"

namespace runstone {
namespace {

std::optional<std::uint64_t> size_of_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error) return std::nullopt;
  return size;
}

}  // namespace

DiskUsage disk_usage_of(const std::string& place) {
  const std::filesystem::path folder(place);
  DiskUsage usage;
  usage.world_bytes = size_of_file(folder / "world.sqlite");
  if (!usage.world_bytes) return usage;
  usage.free_bytes = free_bytes(place);
  usage.wal_bytes = size_of_file(folder / "world.sqlite-wal");
  return usage;
}

}  // namespace runstone
