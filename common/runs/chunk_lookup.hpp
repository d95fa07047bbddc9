// ChunkLookup: how code reads the chunks of a world that somebody else keeps.
#pragma once
#include <functional>
#include <memory>

#include "common/core/coords.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns the chunk of a place of the grid, a cube in any axis order, or null if it is not known.
using ChunkLookup = std::function<std::shared_ptr<const RunChunk>(ChunkCoord)>;

}  // namespace runstone
