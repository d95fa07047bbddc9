// The commands about the password of a world: password, password set, password clear.
#pragma once
#include <span>
#include <string>

#include "common/rights/join_password.hpp"
#include "server/admin/command_row.hpp"

namespace runstone {

struct SetPasswordCommand {
  JoinPassword password;
  bool has_verifier = false;  // false: salt and hash are missing; the control program adds them
  friend bool operator==(const SetPasswordCommand&, const SetPasswordCommand&) = default;
};

std::span<const CommandRow> password_commands();

/// Returns what follows the word `verifier` of `password set`: salt and hash in hexadecimal digits.
std::string verifier_text(const JoinPassword& password);

}  // namespace runstone
