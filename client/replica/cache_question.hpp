// CacheQuestion: chunks that a session would rather have from a cache than from the server.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "client/replica/kept_versions.hpp"
#include "common/core/coords.hpp"
#include "common/runs/chunk.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// A world as its server describes it now: what a cache keeps of it must still be common history.
struct CachedWorld {
  WorldId id{};
  std::uint16_t chunk_edge = 32;
  ServerMark mark;
};

struct CacheQuestion {
  CachedWorld world;
  std::vector<ChunkKey> keys;  // ascending
};

using KeptChunk = std::pair<ChunkKey, ChunkPtr>;

}  // namespace runstone
