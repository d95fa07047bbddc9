#include <algorithm>

#include "common/rights/box_parts.hpp"
#include "common/rights/rights_state.hpp"

namespace runstone {
namespace {

using Reason = RightsDecision::Reason;
using DecidingBox = const Decided<ProtectedBox>*;

const ChangeOrigin& newer_of(const ChangeOrigin& a, const ChangeOrigin& b) {
  return a.seq < b.seq ? b : a;
}

bool admits(const ProtectedBox& box, const PublicKey& key, const Role& role) {
  return role.rights.has(Right::build_protected) || box.owner == key ||
         std::binary_search(box.members.begin(), box.members.end(), key) ||
         std::binary_search(box.roles.begin(), box.roles.end(), role.name);
}

/// Returns true if the edit has a voxel in `from` and in none of `holes`, or if there would be too
/// many parts to know.
bool touches_outside(const VoxelBox& from, const std::vector<DecidingBox>& holes,
                     const TouchesBox& touches) {
  if (!touches(from)) return false;
  std::vector<VoxelBox> parts = {from};
  for (const DecidingBox hole : holes) {
    if (!overlaps(hole->value.box, from)) continue;
    if (!cut_out(parts, hole->value.box, kEditBoxPartsMax)) return true;
    if (parts.empty()) return false;
  }
  return std::any_of(parts.begin(), parts.end(),
                     [&](const VoxelBox& part) { return touches(part); });
}

}  // namespace

std::optional<RightsDecision> RightsState::forbidden(const PublicKey& key, Right right,
                                                     TimeUs now_us) const {
  const auto answer = [&](RestrictionKind kind, Reason reason) -> std::optional<RightsDecision> {
    const Decided<Restrict>* found = restriction(kind, key, now_us);
    if (found == nullptr) return std::nullopt;
    return RightsDecision{false, reason, found->by, role_of(key).name, nullptr};
  };
  if (auto ban = answer(RestrictionKind::ban, Reason::ban)) return ban;
  if (right == Right::chat) return answer(RestrictionKind::mute, Reason::mute);
  if (right == Right::build || right == Right::build_protected || right == Right::undo) {
    return answer(RestrictionKind::freeze, Reason::freeze);
  }
  return std::nullopt;
}

RightsDecision RightsState::decide_by_role(const PublicKey& key, Right right) const {
  const Role& role = role_of(key);
  const Decided<std::string>* grant = grant_of(key);
  RightsDecision decision;
  decision.is_allowed = role.rights.has(right);
  decision.reason = grant == nullptr ? Reason::default_role : Reason::role;
  decision.by = newer_of(grant == nullptr ? default_role_.by : grant->by, find_role(role.name)->by);
  decision.role = role.name;
  return decision;
}

RightsDecision RightsState::decide(const PublicKey& key, Right right, TimeUs now_us) const {
  if (auto answer = forbidden(key, right, now_us)) return *std::move(answer);
  return decide_by_role(key, right);
}

RightsDecision RightsState::decide_edit(const PublicKey& key, const VoxelBox& bounds,
                                        const TouchesBox& touches, TimeUs now_us) const {
  if (auto answer = forbidden(key, Right::build, now_us)) return *std::move(answer);
  RightsDecision free_ground = decide_by_role(key, Right::build);
  const Role& role = role_of(key);
  const auto by_box = [&](bool is_allowed, DecidingBox box) {
    return RightsDecision{is_allowed, Reason::box, box->by, role.name, &box->value};
  };
  // A box that does not admit the player is checked without the admitting boxes that decide before
  // it. The other boxes before it hold no voxel of the edit: it would have been rejected there.
  std::vector<DecidingBox> admitting;
  DecidingBox first_touched = nullptr;
  for (const DecidingBox box : boxes_in(bounds)) {
    const VoxelBox place = intersect(box->value.box, bounds);
    if (admits(box->value, key, role)) {
      admitting.push_back(box);
      if (first_touched == nullptr && touches(place)) first_touched = box;
    } else if (touches_outside(place, admitting, touches)) {
      return by_box(false, box);
    }
  }
  if (!free_ground.is_allowed &&
      (admitting.empty() || touches_outside(bounds, admitting, touches))) {
    return free_ground;
  }
  if (first_touched != nullptr) return by_box(true, first_touched);
  return free_ground;
}

}  // namespace runstone
