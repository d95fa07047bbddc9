#include "server/interest/cache_claims.hpp"

#include "protocol/codec/view_tiles.hpp"

namespace runstone {

bool CacheClaims::add(const CachedChunk& chunk) {
  const auto found = claims_.find(chunk.key);
  if (found != claims_.end()) {
    found->second = chunk;
    return true;
  }
  if (claims_.size() >= kClaimsPerSessionMax) return false;
  claims_.emplace(chunk.key, chunk);
  return true;
}

const CachedChunk* CacheClaims::find(const ChunkKey& key) const {
  const auto found = claims_.find(key);
  return found == claims_.end() ? nullptr : &found->second;
}

void CacheClaims::keep(const View& view) {
  std::erase_if(claims_, [&view](const auto& claim) { return !contains_key(view, claim.first); });
}

}  // namespace runstone
