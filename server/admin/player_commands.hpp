// The commands that need no right, and those for a player's own edits: help, materials, players,
// why, roles, protected, undo, redo.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "common/core/coords.hpp"
#include "server/admin/command_row.hpp"

namespace runstone {

/// The question of `why`: has a player a right, and which record decides it?
struct WhyCommand {
  std::string player;
  Right right{};
  std::optional<VoxelPos> at;  // with Right::build only: whether the player may change this voxel
  friend bool operator==(const WhyCommand&, const WhyCommand&) = default;
};

std::span<const CommandRow> player_commands();

}  // namespace runstone
