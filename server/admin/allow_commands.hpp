// The command that lets the players of a list join.
#pragma once
#include <span>
#include <string>

#include "common/rights/role.hpp"
#include "server/admin/command_row.hpp"

namespace runstone {

struct AllowImportCommand {
  std::string file;
  std::string role = kBuilderRole;
  bool makes_invites = false;  // for names that nobody owns
  friend bool operator==(const AllowImportCommand&, const AllowImportCommand&) = default;
};

std::span<const CommandRow> allow_commands();

}  // namespace runstone
