// DiskUsage: what a world takes on its disk, and what is free there.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace runstone {

/// A size that the system does not say is nullopt. A world in a database has none of them.
struct DiskUsage {
  std::optional<std::uint64_t> free_bytes;   // that this user may still write
  std::optional<std::uint64_t> world_bytes;  // of the file world.sqlite
  std::optional<std::uint64_t> wal_bytes;    // of its write-ahead log
};

/// Measures the disk of the world at `place`. Blocks on the disk.
DiskUsage disk_usage_of(const std::string& place);

}  // namespace runstone
