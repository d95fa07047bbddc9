#include "client/replica/claims.hpp"

namespace runstone {

std::vector<CachedChunk> Claims::take(const ReplicaChunks& chunks) {
  std::vector<CachedChunk> claims;
  for (const auto& [key, chunk] : chunks) {
    if (waiting_.size() >= kClaimsMax) break;
    if (!chunk.confirmed() || chunk.state() != ChunkState::expected) continue;
    if (!claimed_.insert(key).second) continue;
    waiting_.insert(key);
    const Chunk& held = *chunk.confirmed();
    claims.push_back({key, held.version, claim_digest(digest_of(held.voxels))});
  }
  return claims;
}

void Claims::forget(const ChunkKey& key) {
  claimed_.erase(key);
  waiting_.erase(key);
}

void Claims::clear() {
  claimed_.clear();
  waiting_.clear();
}

}  // namespace runstone
