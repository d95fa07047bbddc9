// Layer: the materials of one layer of a chunk, read from its runs. A layer is the largest buffer
// that may hold a material per voxel without counting as a dense expansion (dense.hpp). A mesher
// needs it for a neighbour whose axis order differs from the chunk's.
#pragma once
#include <cstdint>
#include <span>

#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Writes the layer `axis` = `at` of a chunk row by row to out[u + side(u_axis) * v], where u runs
/// along u_axis and v along the remaining axis. Requires at < side(axis), u_axis != axis and
/// out.size() == side(u) * side(v). Cost: O(layer + runs that cross it), with a bisection per line
/// at worst.
void read_layer(const RunChunk& chunk, Axis axis, std::uint32_t at, Axis u_axis,
                std::span<Material> out);

}  // namespace runstone
