// The commands about protected ground: claim, protect, unprotect.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "server/admin/command_row.hpp"

namespace runstone {

/// Protects a box for the one who gives the command.
struct ClaimCommand {
  std::string name;
  VoxelBox box;
  friend bool operator==(const ClaimCommand&, const ClaimCommand&) = default;
};
/// Protects a box, or changes the box of this name. What is not set stays as it is.
struct ProtectCommand {
  std::string name;
  std::optional<VoxelBox> box;  // nullopt: the box exists
  std::optional<std::string> owner;
  std::optional<std::int32_t> priority;
  friend bool operator==(const ProtectCommand&, const ProtectCommand&) = default;
};
/// Adds members and roles to a box, or removes them.
struct BoxMembersCommand {
  std::string name;
  bool is_removal = false;
  std::vector<std::string> players;
  std::vector<std::string> roles;
  friend bool operator==(const BoxMembersCommand&, const BoxMembersCommand&) = default;
};

std::span<const CommandRow> ground_commands();

}  // namespace runstone
