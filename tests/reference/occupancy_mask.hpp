// OccupancyMask: which voxels of a grid are opaque and which are transparent, a word of up to 64 bits a line.
// What a binary mesher may ask for ready: a world that keeps it next to its voxels has it for nothing.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"

namespace runstone::reference {

/// Sides up to which a line fits its word.
inline constexpr unsigned kBinarySideMax = 64;

struct OccupancyMask {
  /// By line, border lines included: line m of slow layer s is word (m + 1) + (m's side + 2) * (s + 1), bit f
  /// its voxel f. The border voxels of a line are in `ends`.
  std::vector<std::uint64_t> opaque, transparent;
  std::vector<std::uint8_t>
      ends;  // bit 0, 1: opaque before, behind the line; bit 2, 3: transparent likewise
  /// No two opaque (transparent) materials occur, so that faces merge and cull without a look at the grid.
  bool one_opaque = true, one_transparent = true;
  bool any_opaque = false, any_transparent = false;
  Material opaque_material = kEmpty,
           transparent_material = kEmpty;  // one that occurs: the only one, if it is
  friend bool operator==(const OccupancyMask&, const OccupancyMask&) = default;
};

/// Replaces `mask` by that of `grid`. Materials are looked up where they change along a line. O(volume / 8).
/// Requires sides up to kBinarySideMax.
void occupancy_of(const DenseGrid& grid, const VisibilityTable& visibility, OccupancyMask& mask);

/// The same for a grid that was decoded from `chunk` and `neighbours`, with the words inside made from the
/// runs. O(runs + lines).
void occupancy_of_decoded(const RunChunk& chunk, const GridNeighbours& neighbours,
                          const DenseGrid& grid, const VisibilityTable& visibility,
                          OccupancyMask& mask);

}  // namespace runstone::reference
