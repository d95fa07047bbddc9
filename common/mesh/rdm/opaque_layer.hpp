// Opaque layer: the opaque voxels of one layer of a chunk as rows of bits, read from its runs in
// any axis order. The veil reads the layers of neighbours with it.
#pragma once
#include <array>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/bit_row.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Rows of a layer of a chunk: the axis across the layer, the axis along the bits of its rows, the
/// coordinate along the first one, and the rows [first_row, end_row).
struct LayerOfBits {
  Axis axis{}, bit_axis{};
  std::uint32_t at = 0;
  std::uint32_t first_row = 0, end_row = 0;
};

/// Replaces `rows`: bit i of row r is set if the voxel is opaque whose coordinate along `bit_axis`
/// is i and whose coordinate along the third axis is r. The other rows are not valid afterwards.
/// Row is Row64 or Row128. Requires a valid chunk, different axes, `at` and the rows inside the
/// chunk, and sides of at most kRowBits<Row>. Cost: O(runs); for a few rows O(rows * (length + log
/// runs)).
template <class Row>
void read_opaque_layer(const RunChunk& chunk, const LayerOfBits& layer,
                       const VisibilityTable& visibility, std::array<Row, kRowBits<Row>>& rows);

}  // namespace runstone
