// The commands about the spawn of the world: its place, and the ground around it that is kept
// clear.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "common/core/coords.hpp"
#include "server/admin/command_row.hpp"

namespace runstone {

/// The protected box with which `spawn keep-clear` keeps the ground.
inline constexpr const char* kSpawnBox = "spawn";
/// The priority of this box. It is higher than that of the boxes of players. A host may open a part
/// of the box with a higher priority.
inline constexpr std::int32_t kSpawnBoxPriority = 500;
inline constexpr std::int64_t kSpawnRadiusMax = 1'000;

/// The new place of the spawn. Without a place it is the place of the player who gives the command.
struct SpawnCommand {
  std::optional<VoxelPos> at;
  friend bool operator==(const SpawnCommand&, const SpawnCommand&) = default;
};

std::span<const CommandRow> spawn_commands();

}  // namespace runstone
