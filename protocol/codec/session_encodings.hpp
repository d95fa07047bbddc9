// SessionEncodings: the encodings in which a session gets chunks and requested tiles
// (docs/protocol.md, *Chunk bytes*).
#pragma once
#include "common/core/coords.hpp"
#include "protocol/chunks/chunk_codec.hpp"

namespace runstone {

struct SessionEncodings {
  ChunkEncoding chunks = ChunkEncoding::raw;  // that of Welcome
  ChunkEncoding tiles = ChunkEncoding::raw;

  ChunkEncoding of(const ChunkKey& key) const { return key.lod == 0 ? chunks : tiles; }
};

}  // namespace runstone
