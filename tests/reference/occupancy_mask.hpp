// OccupancyMask: the opaque and the transparent voxels of a grid, a word of up to 64 bits a line. A
// world that keeps it next to its voxels can give it to a binary mesher without further cost.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"

namespace runstone::reference {

/// The greatest side at which a line fits its word.
inline constexpr unsigned kBinarySideMax = 64;

struct OccupancyMask {
  /// A word for each line, border lines included: line m of slow layer s is word (m + 1) + (m's
  /// side + 2) * (s + 1), and bit f is its voxel f. The border voxels of a line are in `ends`.
  std::vector<std::uint64_t> opaque, transparent;
  // Bits 0 and 1: opaque before and behind the line; bits 2 and 3: transparent before and
  // behind it.
  std::vector<std::uint8_t> ends;
  /// True if no two opaque (transparent) materials occur. Then faces merge and cull without reading
  /// the grid.
  bool one_opaque = true, one_transparent = true;
  bool any_opaque = false, any_transparent = false;
  // A material that occurs; the only one if the flag above is set.
  Material opaque_material = kEmpty, transparent_material = kEmpty;
  friend bool operator==(const OccupancyMask&, const OccupancyMask&) = default;
};

/// Replaces `mask` by that of `grid`. Looks a material up where it changes along a line. Requires
/// sides up to kBinarySideMax. Cost: O(volume / 8).
void occupancy_of(const DenseGrid& grid, const VisibilityTable& visibility, OccupancyMask& mask);

}  // namespace runstone::reference
