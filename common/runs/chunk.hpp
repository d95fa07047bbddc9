// Chunk: voxels with the version they stand at. Published once as std::shared_ptr<const Chunk>: readers never
// lock, a write makes a new one.
#pragma once
#include <memory>

#include "common/core/ids.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

struct Chunk {
  RunChunk voxels;
  Version version;
  Digest digest;  // of voxels; kept in step with them, and recomputed by audits
  friend bool operator==(const Chunk&, const Chunk&) = default;
};

using ChunkPtr = std::shared_ptr<const Chunk>;

}  // namespace runstone
