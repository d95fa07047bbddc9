// CacheLookup: chunks and tiles that a session wants to look up in a cache before it asks the
// server for them.
#pragma once
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "client/replica/shared_history.hpp"
#include "common/core/coords.hpp"
#include "common/runs/chunk.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// A world as its server describes it now. A cache returns only chunks whose history the server
/// still shares.
struct CachedWorld {
  WorldId id{};
  std::uint16_t chunk_edge = 32;
  ServerMark mark;
  /// SessionAccepted::tile_rules. A cache returns only tiles that were kept under the same rules.
  std::uint32_t tile_rules = 0;
};

struct CacheLookup {
  CachedWorld world;
  std::vector<ChunkKey> keys;  // ascending
  /// The memory of the chunks that may be found. Further ones count as missing.
  std::size_t bytes_max = std::numeric_limits<std::size_t>::max();
};

using KeyedChunk = std::pair<ChunkKey, ChunkPtr>;

}  // namespace runstone
