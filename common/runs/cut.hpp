// Cut: a cuboid out of a chunk, on request mirrored, as runs of its own. For clipboards: what a copy takes, and
// the part of a pasted one that lies in a chunk.
#pragma once
#include <cstdint>

#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The voxels of `chunk` from `first` on, `extent` of them along each axis, in the chunk's axis order. Bit 0, 1
/// and 2 of `mirrored` turn the result around along x, y and z. Requires extent.valid_part() and the cuboid
/// inside the chunk. O(runs inside + log runs per line that is cut; whole lines and layers are taken as one).
RunChunk cut(const RunChunk& chunk, LocalPos first, Extent extent, std::uint8_t mirrored = 0);

}  // namespace runstone
