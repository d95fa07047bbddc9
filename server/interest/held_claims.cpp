#include "server/interest/held_claims.hpp"

namespace runstone {

bool HeldClaims::add(const CachedChunk& chunk) {
  const auto found = claims_.find(chunk.key);
  if (found != claims_.end()) {
    found->second = chunk;
    return true;
  }
  if (claims_.size() >= kClaimsPerSessionMax) return false;
  claims_.emplace(chunk.key, chunk);
  return true;
}

const CachedChunk* HeldClaims::find(const ChunkKey& key) const {
  const auto found = claims_.find(key);
  return found == claims_.end() ? nullptr : &found->second;
}

void HeldClaims::keep(const View& view) {
  std::erase_if(claims_, [&view](const auto& claim) { return !view.contains(claim.first.at); });
}

}  // namespace runstone
