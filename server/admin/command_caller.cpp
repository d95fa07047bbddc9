#include "server/admin/command_caller.hpp"

#include <cstddef>

#include "server/admin/rights_reason.hpp"

namespace runstone {

bool has_right(const CommandCaller& caller, const RightsState& state, Right right, TimeUs now_us) {
  if (!caller.actor.key || caller.actor.is_operator) return true;
  return state.decide(*caller.actor.key, right, now_us).is_allowed;
}

std::optional<std::string> why_not(const CommandCaller& caller, const RightsState& state,
                                   const CommandRule& rule, TimeUs now_us) {
  if (!caller.actor.key) return std::nullopt;
  if (rule.is_local) return "this command is for the console and `runstone-server control`";
  if (caller.actor.is_operator || rule.any_of == RightSet()) return std::nullopt;
  const PublicKey& key = *caller.actor.key;
  std::string names;
  std::optional<std::string> restricted;
  for (std::size_t i = 0; i < kRightCount; ++i) {
    const auto right = static_cast<Right>(i);
    if (!rule.any_of.has(right)) continue;
    const RightsDecision decision = state.decide(key, right, now_us);
    if (decision.is_allowed) return std::nullopt;
    names += (names.empty() ? "" : " or ") + std::string(name_of(right));
    if (const auto kind = restriction_of(decision.reason))
      restricted = "you are " + restriction_text(state, *kind, key, now_us);
  }
  if (restricted) return restricted;
  return "this command needs the right " + names + "; your role is " + state.role_of(key).name;
}

}  // namespace runstone
