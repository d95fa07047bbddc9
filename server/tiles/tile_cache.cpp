#include "server/tiles/tile_cache.hpp"

#include <iterator>

namespace runstone {
namespace {

/// Returns about the memory that a tile takes: runs, chunk, and the nodes of list and table.
std::size_t bytes_of(const MadeTile& tile) {
  constexpr std::size_t kNodeBytes = 256;
  const std::size_t veiled_bytes = tile.veiled && tile.veiled != tile.tile
                                       ? tile.veiled->voxels.runs.byte_capacity() + sizeof(Chunk)
                                       : 0;
  return tile.tile->voxels.runs.byte_capacity() + sizeof(Chunk) + veiled_bytes + kNodeBytes;
}

}  // namespace

std::optional<MadeTile> TileCache::find(const ChunkKey& key) {
  const std::lock_guard lock(mutex_);
  const auto found = by_key_.find(key);
  if (found == by_key_.end()) return std::nullopt;
  tiles_.splice(tiles_.begin(), tiles_, found->second);
  return *found->second;
}

void TileCache::put(const MadeTile& tile) {
  const std::lock_guard lock(mutex_);
  if (const auto found = by_key_.find(tile.key); found != by_key_.end()) remove(found->second);
  tiles_.push_front(tile);
  by_key_[tile.key] = tiles_.begin();
  bytes_ += bytes_of(tile);
  while (bytes_ > bytes_max_) remove(std::prev(tiles_.end()));
}

std::size_t TileCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void TileCache::remove(Tiles::iterator tile) {
  bytes_ -= bytes_of(*tile);
  by_key_.erase(tile->key);
  tiles_.erase(tile);
}

}  // namespace runstone
