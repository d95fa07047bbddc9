// Placed clipboard: the places of the cells of a paste in the world. Internal to edits.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns the smallest box of the world that holds the touched cells. Cost: O(1).
VoxelBox box_of(const Paste& paste);

/// Returns true if a touched cell lies in the box. Cost: O(lines of the clipboard inside * log
/// runs).
bool touches(const Paste& paste, const VoxelBox& box);

/// Returns the chunks with a touched cell, ascending. Cost: O(runs * chunks that a run meets +
/// chunks).
std::vector<ChunkCoord> touched_chunks(const Paste& paste, std::int32_t edge);

/// Cell numbers inside a box of the world, in world orientation.
struct PlacedCells {
  VoxelBox box;    // intersection of the requested box and the touched cells' box
  RunChunk cells;  // has the sides of `box`, in the requested order
};

/// Returns nullopt if the touched cells' box misses the box. Cells outside the box cost nothing.
/// Cost: O(runs inside + lines inside * log runs).
std::optional<PlacedCells> placed_cells(const Paste& paste, const VoxelBox& box, AxisOrder order);

}  // namespace runstone
