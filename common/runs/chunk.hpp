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
  /// Of the voxels. It is updated with each edit. In a chunk that arrived in a snapshot it follows
  /// from the digest as sent, which nobody compared with the voxels: code that must find drift
  /// computes digest_of(voxels).
  Digest digest;
  friend bool operator==(const Chunk&, const Chunk&) = default;
};

using ChunkPtr = std::shared_ptr<const Chunk>;

}  // namespace runstone
