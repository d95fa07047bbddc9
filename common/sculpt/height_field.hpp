// HeightField: the heights of an area of columns with fractions, and the operations that brushes
// are made of. Columns without a surface take no part.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/sculpt/brush_weights.hpp"
#include "common/sculpt/ground_surface.hpp"

namespace runstone {

/// A height is a whole number of kHeightUnit parts of a voxel.
inline constexpr std::int64_t kHeightUnit = 256;

struct HeightField {
  std::int32_t width = 0;             // columns along x
  std::vector<std::int64_t> heights;  // in parts of a voxel
  std::vector<bool> has_surface;

  std::size_t size() const { return heights.size(); }
  std::int32_t rounded(std::size_t i) const {
    return static_cast<std::int32_t>((heights[i] + kHeightUnit / 2) >> 8);
  }
  /// Returns a field of the same area with one height.
  static HeightField uniform(const HeightField& area, std::int32_t height) {
    return {area.width, std::vector<std::int64_t>(area.size(), height * kHeightUnit),
            area.has_surface};
  }
};
static_assert(kHeightUnit == 1 << 8);

/// Takes heights as surface_heights() returns them.
HeightField height_field(std::span<const std::int32_t> surface, std::int32_t width);

/// Returns the field moved towards another one, by the share that each column's weight is.
HeightField moved_to(const HeightField& from, std::span<const std::int32_t> weights,
                     const HeightField& target);

/// Returns the field with `change(column)` voxels added, by the share that each column's weight is.
template <class F>
HeightField moved_by(const HeightField& from, std::span<const std::int32_t> weights, F&& change) {
  HeightField out = from;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (weights[i] != 0 && out.has_surface[i])
      out.heights[i] += static_cast<std::int64_t>(change(i) * weights[i]);
  }
  return out;
}
static_assert(kFullWeight == kHeightUnit);

/// Returns for each column the weighted mean height of the columns with a surface up to 2 *
/// `radius` away along both axes: the mean over a square of `radius` columns each way, taken twice.
/// Cost: O(columns).
HeightField mean_heights(const HeightField& field, std::int32_t radius);

/// Lets ground slide `times` times. In each step, a column that is more than a voxel higher than
/// some of its four neighbours gives them half of what is too much, in proportion to the
/// differences, times its weight. Columns of weight 0 neither give nor take, so the sum of the
/// heights stays. Source: thermal erosion (Musgrave, Kolb, Mace 1989). Cost: O(columns * times).
HeightField eroded(const HeightField& field, std::span<const std::int32_t> weights,
                   std::int32_t times);

}  // namespace runstone
