// Chunk: voxels and their version. It is published once as std::shared_ptr<const Chunk>: readers
// never lock, and a write makes a new chunk.
#pragma once
#include <memory>

#include "common/core/ids.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

struct Chunk {
  RunChunk voxels;
  Version version;
  Digest digest;  // of voxels; updated with each edit, recomputed by audits
  friend bool operator==(const Chunk&, const Chunk&) = default;
};

using ChunkPtr = std::shared_ptr<const Chunk>;

}  // namespace runstone
