// DenseBytes: the voxels of a chunk as a palette and one id of a byte each, as a world of dense
// chunks would keep and send them, and the shortest way from them to the input of binary greedy
// meshing. The ids are ordered by visibility, so that two comparisons of a line give its words of
// the occupancy mask.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/reference/palette_decode.hpp"

namespace runstone::reference {

struct DenseBytes {
  Extent extent;
  AxisOrder order = AxisOrder::xyz;
  /// By id: the invisible ones first, then the opaque ones, then the transparent ones.
  std::vector<Material> materials;
  std::uint16_t opaque_first = 0, transparent_first = 0;  // ids
  /// The flattened chunk, and kCompareSlack bytes behind it.
  std::vector<PaletteId> ids;
};

/// Returns the voxels of a chunk, or nullopt if it has more than BytePalette::kIdsMax materials.
std::optional<DenseBytes> dense_bytes(const RunChunk& chunk, const VisibilityTable& visibility);

/// The six chunks around a chunk, by Direction, in its axis order. A null chunk counts as empty.
using DenseNeighbours = std::array<const DenseBytes*, kDirectionCount>;

/// Replaces `out` by a chunk with the adjoining layers of its neighbours. Counts a dense expansion.
/// Requires sides of at most kBinarySideMax. Cost: O(volume / 16).
void fill_volume(const DenseBytes& chunk, const DenseNeighbours& neighbours,
                 const VisibilityTable& visibility, PaletteVolume& out);

}  // namespace runstone::reference
