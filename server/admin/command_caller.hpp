// CommandCaller: who gives a command, and which rights that person has.
#pragma once
#include <optional>
#include <string>

#include "common/rights/change_rules.hpp"
#include "common/rights/rights_state.hpp"
#include "protocol/codec/messages.hpp"
#include "server/admin/command_rules.hpp"

namespace runstone {

struct CommandCaller {
  AuthorId author = 0;  // 0: console or control
  RightsActor actor;    // without a key: console or control
  /// The view of a client that shows what a rollback would change, otherwise nullopt.
  std::optional<View> preview_view = std::nullopt;
};

/// Returns true if the caller has the right now. Console and operators have every right.
bool has_right(const CommandCaller& caller, const RightsState& state, Right right, TimeUs now_us);

/// Returns why the caller may not give a command with this rule, as a sentence, or nullopt. The
/// sentence names the right that is missing and the caller's role, or the restriction.
std::optional<std::string> why_not(const CommandCaller& caller, const RightsState& state,
                                   const CommandRule& rule, TimeUs now_us);

}  // namespace runstone
