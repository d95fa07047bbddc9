// ModelPlacement: where a model lies in a box of voxels. It turns and scales the model, and snaps
// its vertices to integers, so that everything behind it is exact.
//
// A voxel has kVoxelUnit units a side. Coordinates are 0 .. 2^20 (4,096 voxels), so differences
// have 20 bits and a sign, the normal of a triangle (twice its area in a projection) is at most
// 2^40, and the product of a normal and a difference is at most 2^60. Sums of three of them, and
// bounds of a voxel besides, fit 64 bits. Thread: immutable, so any thread may read it.
#pragma once
#include <array>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/edits/clipboard/orientation.hpp"
#include "common/models/model.hpp"

namespace runstone {

/// The units of a side of a voxel.
inline constexpr std::int32_t kVoxelUnit = 256;
/// The longest side of a box of voxels that a model becomes.
inline constexpr std::int32_t kVoxeliseSideMax = 4096;

/// Coordinates along x, y and z in units, 0 .. kVoxeliseSideMax * kVoxelUnit.
using UnitPoint = std::array<std::int32_t, 3>;
using UnitTriangle = std::array<UnitPoint, 3>;

/// The size of the result. One of the two is given, and the other is 0.
struct VoxelScale {
  std::uint32_t longest_side = 0;  // voxels of the longest side of the model, 1 .. kVoxeliseSideMax
  double voxels_per_unit = 0;      // of the positions of the model; above 0
};

class ModelPlacement {
 public:
  /// Places the bounding box of the triangles (of the points, if the model is a cloud) with its
  /// lowest corner at 0. A side is the length in voxels, rounded up, and at least 1. A model
  /// without any length becomes one voxel. Fails with bad_value if not exactly one scale is given
  /// or it is outside its range, and with limit_exceeded if a side is longer than kVoxeliseSideMax.
  /// Requires a model that validate() accepts. Cost: O(triangles).
  static Result<ModelPlacement> of(const Model& model, const Orientation& turn,
                                   const VoxelScale& scale);

  VoxelPos sides() const { return {sides_[0], sides_[1], sides_[2]}; }
  /// Returns the side along an axis, 0 .. 2.
  std::int32_t side(unsigned axis) const { return sides_[axis]; }

  /// Returns a coordinate of a position, rounded to the nearest unit. Requires a vertex of a
  /// triangle, or a point of a cloud.
  std::int32_t along(unsigned axis, const std::array<float, 3>& position) const {
    const Along& a = along_[axis];
    const double length = (double{position[a.source]} - a.begin) * a.scale;
    return static_cast<std::int32_t>(length + 0.5);
  }
  UnitPoint at(const std::array<float, 3>& position) const {
    return {along(0, position), along(1, position), along(2, position)};
  }
  UnitTriangle triangle(const Model& model, std::size_t index) const {
    const auto& corners = model.triangles[index];
    return {at(model.positions[corners[0]]), at(model.positions[corners[1]]),
            at(model.positions[corners[2]])};
  }

 private:
  struct Along {
    unsigned source = 0;  // axis of the model
    double begin = 0;     // coordinate of the model that becomes 0
    double scale = 0;     // units for each unit of the model; negative: the axis is reversed
  };
  std::array<Along, 3> along_;
  std::array<std::int32_t, 3> sides_{1, 1, 1};
};

}  // namespace runstone
