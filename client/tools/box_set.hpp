// BoxSet: a set of voxels as a few boxes that do not overlap. It is the form of a selection. One
// thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/core/coords.hpp"

namespace runstone {

class BoxSet {
 public:
  /// The boxes of a set, at most. It bounds the work of each function.
  static constexpr std::size_t kBoxesMax = 256;

  BoxSet() = default;
  /// Returns the voxels of a box, which may be empty.
  explicit BoxSet(const VoxelBox& box);

  bool empty() const { return boxes_.empty(); }
  /// Returns the boxes. None is empty. Their number and order depend on how the set was made.
  std::span<const VoxelBox> boxes() const { return boxes_; }
  /// Returns the smallest box around all voxels.
  VoxelBox around() const;
  bool contains(VoxelPos voxel) const;

  /// Returns the union, the difference a minus b, and the intersection. Fails with nullopt if the
  /// result, or a set on the way to it, has more than kBoxesMax boxes. Cost: O(boxes of one set *
  /// boxes of the other, and those of the result squared).
  static std::optional<BoxSet> united(const BoxSet& a, const BoxSet& b);
  static std::optional<BoxSet> without(const BoxSet& a, const BoxSet& b);
  static std::optional<BoxSet> common(const BoxSet& a, const BoxSet& b);

  /// Returns the set moved by some steps.
  BoxSet moved(Direction direction, std::int32_t steps) const;
  /// Compares the boxes in their order. Sets of the same voxels may have different boxes.
  friend bool operator==(const BoxSet&, const BoxSet&) = default;
  /// Returns the set and all voxels up to `steps` behind it in a direction. Fails with nullopt if the
  /// result has more than kBoxesMax boxes. Requires 0 <= steps. Cost: O(boxes of the set * those of
  /// the result, and those of the result squared).
  std::optional<BoxSet> grown(Direction direction, std::int32_t steps) const;
  /// Returns the voxels behind which all voxels up to `steps` in a direction are in the set. Requires
  /// 0 <= steps.
  std::optional<BoxSet> shrunk(Direction direction, std::int32_t steps) const;

 private:
  /// Joins boxes that together are a box. Returns false if there are more than kBoxesMax.
  bool simplify();

  std::vector<VoxelBox> boxes_;
};

}  // namespace runstone
