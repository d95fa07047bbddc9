#include "client/replica/known_ground.hpp"

#include <algorithm>
#include <vector>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/rights/box_index.hpp"
#include "common/rights/ground_decision.hpp"
#include "common/rights/right.hpp"
#include "protocol/limits.hpp"
#include "protocol/rules/refusal_text.hpp"

namespace runstone {
namespace {

BoxRank rank_of_ground(const GroundBox& box) { return {box.priority, box.seq, box.name}; }

}  // namespace

void KnownGround::clear() {
  permissions_.reset();
  boxes_.clear();
}

Result<void> KnownGround::receive(const ProtectedGround& change) {
  for (const Sequence seq : change.removed) boxes_.erase(seq);
  for (const GroundBox& box : change.boxes) boxes_[box.seq] = box;
  if (boxes_.size() > kGroundBoxesMax)
    return fail(ErrorCode::limit_exceeded, "more than 1024 protected boxes");
  return {};
}

std::optional<std::string> KnownGround::refusal(const EditDescriptor& edit) const {
  if (permissions_ && !permissions_->edits_refused.empty()) return permissions_->edits_refused;
  const std::uint64_t volume_max = permissions_ ? permissions_->edit_volume_max : 0;
  if (volume_max != 0 && counted_voxels(edit) > volume_max) return refused_by_volume(volume_max);
  const VoxelBox bounds = bounding_box(edit);
  std::vector<const GroundBox*> near;
  for (const auto& [seq, box] : boxes_) {
    if (overlaps(box.box, bounds)) near.push_back(&box);
  }
  std::sort(near.begin(), near.end(), [](const GroundBox* a, const GroundBox* b) {
    return decides_before(rank_of_ground(*a), rank_of_ground(*b));
  });
  std::vector<GroundRule> rules;
  rules.reserve(near.size());
  for (const GroundBox* box : near) rules.push_back({box->box, box->admits});
  const bool may_build = !permissions_ || RightSet::of_bits(permissions_->rights).has(Right::build);
  const GroundDecision decision = decide_ground(
      rules, bounds, may_build, [&edit](const VoxelBox& box) { return touches(edit, box); });
  if (decision.is_allowed) return std::nullopt;
  return decision.rule ? refused_by_box(near[*decision.rule]->name)
                       : refused_by_role(permissions_->role);
}

}  // namespace runstone
