// Placed clipboard: where the cells of a paste lie in the world. Internal to edits.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Smallest box of the world that holds the touched cells. O(1).
VoxelBox box_of(const Paste& paste);

/// Whether a touched cell lies in the box. O(lines of the clipboard inside * log runs).
bool touches(const Paste& paste, const VoxelBox& box);

/// Chunks with a touched cell, ascending. O(runs * chunks that a run meets + chunks).
std::vector<ChunkCoord> touched_chunks(const Paste& paste, std::int32_t edge);

/// Cell numbers inside a box of the world, as they lie there.
struct PlacedCells {
  VoxelBox box;    // of the box that was asked for, what the touched cells' box meets
  RunChunk cells;  // its sides; in the order that was asked for
};

/// Nothing if the touched cells' box misses the box. O(runs inside + lines inside * log runs): what lies outside costs
/// nothing.
std::optional<PlacedCells> placed_cells(const Paste& paste, const VoxelBox& box, AxisOrder order);

}  // namespace runstone
