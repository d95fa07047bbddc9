// TileCache: the tiles that were made or read last, up to a number of bytes. Threads: any. The
// mutex is a leaf.
#pragma once
#include <cstddef>
#include <list>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "server/interest/chunk_key_hash.hpp"
#include "server/world/environment/tile_request.hpp"

namespace runstone {

class TileCache {
 public:
  explicit TileCache(std::size_t bytes_max) : bytes_max_(bytes_max) {}

  /// Returns the tile, which becomes the one that was used last, or nullopt if it is not there.
  std::optional<MadeTile> find(const ChunkKey& key);
  /// Adds a tile or replaces the one of its key. Removes those that were not used for longest while
  /// the tiles take more than the number of bytes.
  void put(const MadeTile& tile);
  std::size_t bytes() const;

 private:
  using Tiles = std::list<MadeTile>;
  void remove(Tiles::iterator tile);

  const std::size_t bytes_max_;
  mutable std::mutex mutex_;
  Tiles tiles_;  // the one that was used last comes first
  std::unordered_map<ChunkKey, Tiles::iterator, ChunkKeyHash> by_key_;
  std::size_t bytes_ = 0;
};

}  // namespace runstone
