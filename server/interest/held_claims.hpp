// HeldClaims: what a session said it holds, until the chunk's turn comes and it is answered. Bounded by kClaimsPerSessionMax.
// One thread.
#pragma once
#include <cstddef>
#include <span>
#include <unordered_map>

#include "protocol/codec/messages.hpp"
#include "server/interest/chunk_key_hash.hpp"

namespace runstone {

class HeldClaims {
 public:
  /// A later claim of a chunk replaces an earlier one. False: there is no room, and nothing was taken.
  [[nodiscard]] bool add(const CachedChunk& chunk);
  /// Null if nothing is claimed of it. Lives until the next change.
  const CachedChunk* find(const ChunkKey& key) const;
  void drop(const ChunkKey& key) { claims_.erase(key); }
  /// Forgets what lies outside of the view. O(claims).
  void keep(const View& view);
  void clear() { claims_.clear(); }
  std::size_t count() const { return claims_.size(); }

 private:
  std::unordered_map<ChunkKey, CachedChunk, ChunkKeyHash> claims_;
};

}  // namespace runstone
