#include "client/replica/claims.hpp"

#include "protocol/codec/view_tiles.hpp"

namespace runstone {

std::vector<CachedChunk> Claims::take(const ReplicaChunks& chunks, const FarTiles& tiles) {
  std::vector<CachedChunk> claims;
  for (const auto& [key, chunk] : chunks) {
    if (waiting_.size() >= kClaimsMax) break;
    if (!chunk.confirmed() || chunk.state() != ChunkState::expected) continue;
    if (!claimed_.insert(key).second) continue;
    waiting_.insert(key);
    const Chunk& held = *chunk.confirmed();
    claims.push_back({key, held.version, claim_digest(digest_of(held.voxels))});
  }
  tiles.for_each_claimable([&](const ChunkKey& key, const Chunk& tile) {
    if (waiting_.size() >= kClaimsMax) return false;
    if (claimed_.contains(key) || digest_of(tile.voxels) != tile.digest) return true;
    claimed_.insert(key);
    waiting_.insert(key);
    claims.push_back({key, tile.version, claim_digest(tile.digest)});
    return true;
  });
  return claims;
}

void Claims::forget(const ChunkKey& key) {
  claimed_.erase(key);
  waiting_.erase(key);
}

void Claims::forget_tiles_outside(const View& view) {
  const auto has_left = [&view](const ChunkKey& key) {
    return key.lod > 0 && !contains_key(view, key);
  };
  std::erase_if(claimed_, has_left);
  std::erase_if(waiting_, has_left);
}

void Claims::clear() {
  claimed_.clear();
  waiting_.clear();
}

}  // namespace runstone
