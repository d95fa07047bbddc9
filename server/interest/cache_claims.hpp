// CacheClaims: the copies of chunks and tiles that a client claims to have, until the server
// answers the claim. Bound: kClaimsPerSessionMax. One thread.
#pragma once
#include <cstddef>
#include <span>
#include <unordered_map>

#include "protocol/codec/messages.hpp"
#include "server/interest/chunk_key_hash.hpp"

namespace runstone {

class CacheClaims {
 public:
  /// Adds a claim, or replaces the claim of the same chunk. Returns false if there is no room for a
  /// new one.
  [[nodiscard]] bool add(const CachedChunk& chunk);
  /// Returns the claim of this chunk, or null if there is none. The pointer is valid until the next
  /// change.
  const CachedChunk* find(const ChunkKey& key) const;
  void drop(const ChunkKey& key) { claims_.erase(key); }
  /// Removes claims outside of the view. Cost: O(claims).
  void keep(const View& view);
  void clear() { claims_.clear(); }
  std::size_t count() const { return claims_.size(); }

 private:
  std::unordered_map<ChunkKey, CachedChunk, ChunkKeyHash> claims_;
};

}  // namespace runstone
