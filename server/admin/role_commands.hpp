// The commands about roles, grants and invites, and the one that takes a record about rights back.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "common/core/ids.hpp"
#include "common/rights/right.hpp"
#include "common/rights/role.hpp"
#include "server/admin/command_row.hpp"

namespace runstone {

struct GrantCommand {
  std::string player;
  std::string role;
  TimeUs until_us = 0;  // UTC; 0: without an end
  friend bool operator==(const GrantCommand&, const GrantCommand&) = default;
};
struct CreateInviteCommand {
  std::string role = kBuilderRole;
  std::uint32_t uses = 1;
  TimeUs until_us = 0;  // UTC
  friend bool operator==(const CreateInviteCommand&, const CreateInviteCommand&) = default;
};

/// Takes rights, separated by commas without blanks, or "none". `word` is what stands before them.
RightSet take_rights(WordReader& reader, const std::string& word);

std::span<const CommandRow> role_commands();

}  // namespace runstone
