#include "server/admin/rights_reason.hpp"

#include "common/core/key_text.hpp"
#include "common/core/utc_text.hpp"
#include "common/rights/restriction_text.hpp"
#include "server/admin/rights_change_text.hpp"

namespace runstone {
namespace {

/// Returns what decides, without the record.
std::string decided_by(const RightsState& state, const RightsDecision& decision,
                       const PublicKey& key, TimeUs now_us) {
  using Reason = RightsDecision::Reason;
  if (const auto kind = restriction_of(decision.reason))
    return "the player is " + why_restricted(state, *kind, key, now_us);
  if (decision.reason == Reason::box && decision.box != nullptr)
    return "the ground is protected: " + decision.box->name + " " + box_text(*decision.box);
  const Decided<Role>* role = state.find_role(decision.role);
  const std::string rights = role == nullptr ? "" : " is " + role_text(role->value);
  if (decision.reason == Reason::default_role) {
    const bool is_choice = decision.by == state.default_role().by;
    return "the player has no grant, and the default role " +
           (is_choice ? "is " + decision.role : decision.role + rights);
  }
  if (const auto* timed = state.timed_grant(key, now_us); timed && timed->by == decision.by)
    return "the player was given the role " + decision.role + " until " +
           utc_text(timed->value.until_us);
  const auto grant = state.grants().find(key);
  if (grant != state.grants().end() && grant->second.by == decision.by)
    return "the player was given the role " + decision.role;
  return "the role " + decision.role + rights;
}

}  // namespace

std::optional<RestrictionKind> restriction_of(RightsDecision::Reason reason) {
  using Reason = RightsDecision::Reason;
  if (reason == Reason::ban) return RestrictionKind::ban;
  if (reason == Reason::mute) return RestrictionKind::mute;
  if (reason == Reason::freeze) return RestrictionKind::freeze;
  return std::nullopt;
}

std::string why_restricted(const RightsState& state, RestrictionKind kind, const PublicKey& key,
                           TimeUs now_us) {
  const Decided<Restrict>* found = state.restriction(kind, key, now_us);
  const char* what = restricted_text(kind);
  return found == nullptr ? what : restriction_text(what, found->value);
}

std::string origin_text(const ChangeOrigin& origin, const KnownPlayers& players) {
  if (origin.seq == 0) return "built in";
  return "record " + std::to_string(origin.seq) + ", " + utc_text(origin.time_us) + ", by " +
         players.text_of(origin.author);
}

std::string rights_reason(const RightsState& state, const RightsQuestion& question, TimeUs now_us,
                          const KnownPlayers& players) {
  RightsDecision decision;
  std::string verb;
  if (question.at) {
    const VoxelPos at = *question.at;
    const VoxelBox voxel{at, {at.x + 1, at.y + 1, at.z + 1}};
    const auto touches = [at](const VoxelBox& box) { return box.contains(at); };
    decision = state.decide_edit(question.key, voxel, touches, now_us);
    verb =
        (decision.is_allowed ? "may change the voxel " : "may not change the voxel ") + text_of(at);
  } else {
    decision = state.decide(question.key, question.right, now_us);
    verb = (decision.is_allowed ? "has the right " : "does not have the right ") +
           std::string(name_of(question.right));
  }
  return (decision.is_allowed ? "yes: " : "no: ") + players.text_of(question.key) + " " + verb +
         "\n" + decided_by(state, decision, question.key, now_us) + " (" +
         origin_text(decision.by, players) + ")";
}

}  // namespace runstone
