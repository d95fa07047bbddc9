// The command that makes a box of the running world as it was in a backup.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "server/admin/command_row.hpp"

namespace runstone {

/// The greatest number of voxels of the box. A worker reads the backup and the world, and holds
/// both in memory.
inline constexpr std::uint64_t kRestoredVoxelsMax = std::uint64_t{64} << 20;

struct RestoreBoxCommand {
  std::string backup;  // a folder with a copy of the world, or another place of one
  VoxelBox box;
  std::optional<TimeUs> at_us;  // UTC; nullopt: the end of the backup
  friend bool operator==(const RestoreBoxCommand&, const RestoreBoxCommand&) = default;
};

std::span<const CommandRow> restore_box_commands();

}  // namespace runstone
