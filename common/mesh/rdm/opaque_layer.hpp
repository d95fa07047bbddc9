// Opaque layer: the opaque voxels of one layer of a chunk as rows of bits, read from its runs in any
// axis order. Veils read the layers of neighbours with it.
#pragma once
#include <array>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/bit_row.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// A layer of a chunk: the axis across it, the axis along the bits of its rows, and the coordinate
/// along the first one.
struct LayerOfBits {
  Axis axis{}, bit_axis{};
  std::uint32_t at = 0;
};

/// Replaces `rows`: bit i of row r is set if the voxel is opaque whose coordinate along `bit_axis`
/// is i and whose coordinate along the third axis is r. Row is Row64 or Row128. Requires a valid
/// chunk, different axes, `at` inside the chunk and sides of at most kRowBits<Row>. Cost: O(runs +
/// rows), and O(log runs) for each row if the chunk has many runs.
template <class Row>
void read_opaque_layer(const RunChunk& chunk, const LayerOfBits& layer,
                       const VisibilityTable& visibility, std::array<Row, kRowBits<Row>>& rows);

}  // namespace runstone
