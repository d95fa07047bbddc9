#include <algorithm>

#include "common/rights/ground_decision.hpp"
#include "common/rights/rights_state.hpp"

namespace runstone {
namespace {

using Reason = RightsDecision::Reason;
using DecidingBox = const Decided<ProtectedBox>*;

const ChangeOrigin& newer_of(const ChangeOrigin& a, const ChangeOrigin& b) {
  return a.seq < b.seq ? b : a;
}

/// The rights that a restriction takes from a player.
constexpr RightSet taken_by(RestrictionKind kind) {
  switch (kind) {
    case RestrictionKind::ban:
      return RightSet::all();
    case RestrictionKind::mute:
      return {Right::chat};
    case RestrictionKind::freeze:
      break;
  }
  return {Right::build, Right::build_protected, Right::undo};
}

}  // namespace

std::optional<RightsDecision> RightsState::forbidden(const PublicKey& key, Right right,
                                                     TimeUs now_us) const {
  const auto answer = [&](RestrictionKind kind, Reason reason) -> std::optional<RightsDecision> {
    const Decided<Restrict>* found = restriction(kind, key, now_us);
    if (found == nullptr) return std::nullopt;
    return RightsDecision{false, reason, found->by, role_of(key, now_us).name, nullptr};
  };
  if (auto ban = answer(RestrictionKind::ban, Reason::ban)) return ban;
  if (taken_by(RestrictionKind::mute).has(right))
    return answer(RestrictionKind::mute, Reason::mute);
  if (taken_by(RestrictionKind::freeze).has(right))
    return answer(RestrictionKind::freeze, Reason::freeze);
  return std::nullopt;
}

RightSet RightsState::rights_in_force(const PublicKey& key, TimeUs now_us) const {
  RightSet rights = role_of(key, now_us).rights;
  for (const RestrictionKind kind :
       {RestrictionKind::ban, RestrictionKind::mute, RestrictionKind::freeze}) {
    if (restriction(kind, key, now_us) != nullptr)
      rights = RightSet::of_bits(rights.bits() & ~taken_by(kind).bits());
  }
  return rights;
}

bool admits(const ProtectedBox& box, const PublicKey& key, const Role& role) {
  return role.rights.has(Right::build_protected) || box.owner == key ||
         std::binary_search(box.members.begin(), box.members.end(), key) ||
         std::binary_search(box.roles.begin(), box.roles.end(), role.name);
}

RightsDecision RightsState::decide_by_role(const PublicKey& key, Right right, TimeUs now_us) const {
  const Role& role = role_of(key, now_us);
  const Granted grant = granted_at(key, now_us);
  const bool is_granted = grant.role != nullptr;
  RightsDecision decision;
  decision.is_allowed = role.rights.has(right);
  decision.reason = is_granted ? Reason::role : Reason::default_role;
  decision.by = newer_of(is_granted ? grant.by : default_role_.by, find_role(role.name)->by);
  decision.role = role.name;
  return decision;
}

RightsDecision RightsState::decide(const PublicKey& key, Right right, TimeUs now_us) const {
  if (auto answer = forbidden(key, right, now_us)) return *std::move(answer);
  return decide_by_role(key, right, now_us);
}

RightsDecision RightsState::decide_edit(const PublicKey& key, const VoxelBox& bounds,
                                        const TouchesBox& touches, TimeUs now_us) const {
  if (auto answer = forbidden(key, Right::build, now_us)) return *std::move(answer);
  const RightsDecision free_ground = decide_by_role(key, Right::build, now_us);
  const Role& role = role_of(key, now_us);
  const std::vector<DecidingBox> boxes = boxes_in(bounds);
  std::vector<GroundRule> rules;
  rules.reserve(boxes.size());
  for (const DecidingBox box : boxes)
    rules.push_back({box->value.box, admits(box->value, key, role)});
  const GroundDecision ground = decide_ground(rules, bounds, free_ground.is_allowed, touches);
  if (!ground.rule) return free_ground;
  const DecidingBox box = boxes[*ground.rule];
  return {ground.is_allowed, Reason::box, box->by, role.name, &box->value};
}

}  // namespace runstone
