// Cut: copies a cuboid out of a chunk, mirrored on request, as runs of its own. Clipboards use it
// to copy a selection, and to take the part of a pasted clipboard that lies in a chunk.
#pragma once
#include <cstdint>

#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns `extent` voxels of `chunk` from `first` on, in the chunk's axis order. Bits 0, 1 and 2
/// of `mirrored` reverse the result along x, y and z. Requires extent.valid_part() and the cuboid
/// inside the chunk. Cost: O(runs inside + log runs per line that is cut); whole lines and layers
/// count as one.
RunChunk cut(const RunChunk& chunk, LocalPos first, Extent extent, std::uint8_t mirrored = 0);

}  // namespace runstone
