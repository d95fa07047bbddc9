#include "common/sculpt/tube.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/assert.hpp"
#include "common/sculpt/row_build.hpp"
#include "common/sculpt/solid.hpp"
#include "common/sculpt/voxel_rows.hpp"

namespace runstone {
namespace {

/// A middle at exactly half the thickness belongs to the tube, whatever way its place was rounded.
constexpr double kTubeRounding = 1e-9;

std::int32_t floor_to_voxel(double value) { return static_cast<std::int32_t>(std::floor(value)); }

/// Adds the ball around a point.
void add_ball(const CurvePoint& point, double radius, VoxelRows& out) {
  const std::int32_t in_x = floor_to_voxel(point.x);
  out.add(floor_to_voxel(point.y), floor_to_voxel(point.z), {in_x, in_x + 1});
  const double square = radius * radius + kTubeRounding;
  for (std::int32_t z = floor_to_voxel(point.z - radius); z <= floor_to_voxel(point.z + radius);
       ++z) {
    for (std::int32_t y = floor_to_voxel(point.y - radius); y <= floor_to_voxel(point.y + radius);
         ++y) {
      const double off_y = y + 0.5 - point.y, off_z = z + 0.5 - point.z;
      const double left = square - off_y * off_y - off_z * off_z;
      if (left < 0) continue;
      const double half = std::sqrt(left);
      const auto low = static_cast<std::int32_t>(std::ceil(point.x - half - 0.5));
      const std::int32_t high = floor_to_voxel(point.x + half - 0.5) + 1;
      if (low < high) out.add(y, z, {low, high});
    }
  }
}

}  // namespace

std::vector<CurvePoint> tube_line(const Tube& tube, std::span<const VoxelPos> places) {
  std::vector<CurvePoint> out;
  if (tube.bend == TubeBend::curve || places.size() < 2) {
    out = curve_through(places);
  } else {
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      const auto part = curve_through(places.subspan(i, 2));
      out.insert(out.end(), part.begin(), part.end());
    }
  }
  if (tube.thickness % 2 == 0) {
    for (CurvePoint& point : out) point = {point.x + 0.5, point.y + 0.5, point.z + 0.5};
  }
  return out;
}

Result<PlacedBuild> tube_build(const Tube& tube, std::span<const VoxelPos> places,
                               Material material) {
  RUNSTONE_ASSERT(tube.thickness > 0 && tube.thickness <= kTubeThicknessMax);
  const auto line = tube_line(tube, places);
  // Points are half a voxel apart.
  if (line.size() > std::size_t{2} * kTubeLengthMax)
    return fail(ErrorCode::limit_exceeded, "the curve is longer than 8,192 voxels");
  VoxelRows rows;
  for (const CurvePoint& point : line) add_ball(point, tube.thickness / 2.0, rows);
  rows.join();
  const VoxelBox& box = rows.box();
  const VoxelPos sides{box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
  if (std::max({sides.x, sides.y, sides.z}) > kSolidSideMax)
    return fail(ErrorCode::limit_exceeded, "the curve reaches farther than 1,024 voxels");
  auto build = build_of_rows(sides, Axis::y, material,
                             [&](std::int32_t y, std::int32_t z, std::vector<RowStretch>& out) {
                               const auto* const row = rows.row(y + box.min.y, z + box.min.z);
                               if (row == nullptr) return;
                               for (const RowStretch& part : *row)
                                 out.push_back({part.low - box.min.x, part.high - box.min.x});
                             });
  if (!build) return failure(build.error());
  return PlacedBuild{box.min, *std::move(build)};
}

}  // namespace runstone
