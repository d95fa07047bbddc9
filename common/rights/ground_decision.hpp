// Ground decision: whether an edit may be made where boxes protect the ground. The server decides
// by it with all boxes of the world (RightsState::decide_edit()), and a client with the boxes that
// it has received. So a client that has every box which overlaps an edit decides as the server
// does.
// Pure. Threads: any.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// Answers whether the edit under check has a voxel in the box. Exact: a bounding box does not do.
using TouchesBox = std::function<bool(const VoxelBox&)>;

/// The most parts that decide_ground() makes of one box.
inline constexpr std::size_t kEditBoxPartsMax = 4096;

/// What orders protected boxes.
struct BoxRank {
  std::int32_t priority = 0;
  Sequence seq = 0;  // of the record that made the box
  std::string_view name;
};
/// Returns true if box `a` decides before box `b` where both hold a voxel.
constexpr bool decides_before(const BoxRank& a, const BoxRank& b) {
  if (a.priority != b.priority) return a.priority > b.priority;
  if (a.seq != b.seq) return a.seq > b.seq;
  return a.name < b.name;
}

/// A protected box, as it matters to one player.
struct GroundRule {
  VoxelBox box;         // not empty
  bool admits = false;  // the player
};

struct GroundDecision {
  bool is_allowed = false;
  std::optional<std::size_t> rule;  // the one that decides; nullopt: the free ground does
};

/// Decides whether a player may make an edit. The rule: an edit is refused as a whole if the player
/// may not change a single one of its voxels. `rules` has every box that overlaps `bounds`, the
/// bounding box of the edit; those that decide first come first. `may_build` says whether the
/// player may change free ground. If the edit is allowed and a box admits the player to a part of
/// it, the answer names the box that decides first. Requires that the edit has a voxel in `bounds`.
/// `touches` is called with boxes in `bounds` that are not empty. Cost for m rules: m + p calls of
/// `touches` and O(m * p) cuts, where p is the number of parts. At most kEditBoxPartsMax parts are
/// made of one box: an edit that would need more is refused.
GroundDecision decide_ground(std::span<const GroundRule> rules, const VoxelBox& bounds,
                             bool may_build, const TouchesBox& touches);

}  // namespace runstone
