#include "common/rights/ground_decision.hpp"

#include <algorithm>
#include <vector>

#include "common/rights/box_index.hpp"
#include "common/rights/box_parts.hpp"

namespace runstone {
namespace {

/// Returns true if the edit has a voxel in `from` and in none of `holes`, or if there would be too
/// many parts to know.
bool touches_outside(const VoxelBox& from, const std::vector<VoxelBox>& holes,
                     const TouchesBox& touches) {
  if (!touches(from)) return false;
  std::vector<VoxelBox> parts = {from};
  for (const VoxelBox& hole : holes) {
    if (!overlaps(hole, from)) continue;
    if (!cut_out(parts, hole, kEditBoxPartsMax)) return true;
    if (parts.empty()) return false;
  }
  return std::any_of(parts.begin(), parts.end(),
                     [&](const VoxelBox& part) { return touches(part); });
}

}  // namespace

GroundDecision decide_ground(std::span<const GroundRule> rules, const VoxelBox& bounds,
                             bool may_build, const TouchesBox& touches) {
  // A box that does not admit the player is checked without the admitting boxes that decide before
  // it. The other boxes before it hold no voxel of the edit: it would have been refused there.
  std::vector<VoxelBox> admitting;
  std::optional<std::size_t> first_touched;
  for (std::size_t i = 0; i < rules.size(); ++i) {
    const VoxelBox place = intersect(rules[i].box, bounds);
    if (rules[i].admits) {
      admitting.push_back(rules[i].box);
      if (!first_touched && touches(place)) first_touched = i;
    } else if (touches_outside(place, admitting, touches)) {
      return {false, i};
    }
  }
  if (!may_build && (admitting.empty() || touches_outside(bounds, admitting, touches)))
    return {false, std::nullopt};
  return {may_build || first_touched, first_touched};
}

}  // namespace runstone
