// Layer: the materials of one layer of a chunk, read straight from runs. The largest thing that may be
// expanded (design invariant 1): what a mesher needs from a neighbour whose axis order differs from its own.
#pragma once
#include <cstdint>
#include <span>

#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Writes the layer `axis` = `at` of a chunk, row by row: out[u + side(u_axis) * v] for the two other axes in
/// the order given by u_axis (the fast one) and the remaining one. Requires at < side(axis), u_axis != axis
/// and out.size() == side(u) * side(v). O(layer + runs crossed by it, with a bisection per line at worst).
void read_layer(const RunChunk& chunk, Axis axis, std::uint32_t at, Axis u_axis,
                std::span<Material> out);

}  // namespace runstone
