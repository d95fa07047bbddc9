// MapCaches: what the map keeps in memory. Each entry is found by its place and its version, so an
// entry is outdated only if materials get shapes, which empties the caches. The present and the
// past share what is equal in both.
#pragma once
#include <cstddef>
#include <string>
#include <tuple>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/map/map_tops.hpp"
#include "common/runs/run_chunk.hpp"
#include "server/map/lru_cache.hpp"
#include "server/map/map_geometry.hpp"

namespace runstone {

struct MapCaches {
  /// Shares `bytes_max` among the three.
  explicit MapCaches(std::size_t bytes_max)
      : pictures(bytes_max / 2), tops(bytes_max / 4), tiles(bytes_max / 4) {}

  void clear() {
    pictures.clear();
    tops.clear();
    tiles.clear();
  }
  std::size_t bytes() const { return pictures.bytes() + tops.bytes() + tiles.bytes(); }

  LruCache<std::pair<MapPlace, Version>, std::string> pictures;  // PNG files
  LruCache<std::pair<ColumnKey, Version>, MapTops> tops;         // of a column of chunks
  LruCache<std::pair<ChunkKey, Version>, RunChunk> tiles;        // of level 1 and above
};

}  // namespace runstone
