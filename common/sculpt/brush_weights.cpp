#include "common/sculpt/brush_weights.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

double share(double distance, BrushFalloff falloff) {
  const double t = std::clamp(distance, 0.0, 1.0);
  switch (falloff) {
    case BrushFalloff::smooth:
      return 1.0 - t * t * (3.0 - 2.0 * t);
    case BrushFalloff::linear:
      return 1.0 - t;
    case BrushFalloff::round:
      return std::sqrt(1.0 - t * t);
    case BrushFalloff::none:
      return 1.0;
  }
  return 0.0;
}

/// Returns the square of the horizontal distance of a column from a segment.
double square_distance(double x, double z, const VoxelPos& a, const VoxelPos& b) {
  const double along_x = b.x - a.x, along_z = b.z - a.z;
  const double to_x = x - a.x, to_z = z - a.z;
  const double square = along_x * along_x + along_z * along_z;
  const double t =
      square > 0 ? std::clamp((to_x * along_x + to_z * along_z) / square, 0.0, 1.0) : 0.0;
  const double off_x = to_x - t * along_x, off_z = to_z - t * along_z;
  return off_x * off_x + off_z * off_z;
}

}  // namespace

std::vector<std::int32_t> brush_weights(const VoxelBox& box, std::span<const VoxelPos> places,
                                        std::int32_t radius, BrushFalloff falloff) {
  RUNSTONE_ASSERT(!places.empty() && radius > 0);
  const std::int32_t width = box.max.x - box.min.x;
  std::vector<std::int32_t> out(static_cast<std::size_t>(width) *
                                static_cast<std::size_t>(box.max.z - box.min.z));
  const double reach = radius + 0.5;
  // A column has the weight of its nearest segment, so the weight is worked out once.
  std::vector<double> nearest(out.size(), reach * reach);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const VoxelPos &a = places[i], &b = places[i + 1 < places.size() ? i + 1 : i];
    if (i > 0 && i + 1 == places.size()) break;  // the end of the last segment
    const std::int32_t low_x = std::max(box.min.x, std::min(a.x, b.x) - radius);
    const std::int32_t high_x = std::min(box.max.x, std::max(a.x, b.x) + radius + 1);
    const std::int32_t low_z = std::max(box.min.z, std::min(a.z, b.z) - radius);
    const std::int32_t high_z = std::min(box.max.z, std::max(a.z, b.z) + radius + 1);
    for (std::int32_t z = low_z; z < high_z; ++z) {
      double* const row = nearest.data() +
                          static_cast<std::size_t>(width) * static_cast<std::size_t>(z - box.min.z);
      for (std::int32_t x = low_x; x < high_x; ++x) {
        double& present = row[x - box.min.x];
        present = std::min(present, square_distance(x, z, a, b));
      }
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (nearest[i] >= reach * reach) continue;
    out[i] = static_cast<std::int32_t>(
        std::lround(share(std::sqrt(nearest[i]) / reach, falloff) * kFullWeight));
  }
  return out;
}

}  // namespace runstone
