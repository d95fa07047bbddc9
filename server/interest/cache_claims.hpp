// CacheClaims: the copies of chunks and tiles that a client claims to have, until the server
// answers the claim. Bound: kClaimsPerSessionMax. One thread.
//
// The claims are kept in the order of their keys, in blocks of bounded size. The client chooses the
// keys, so it could make all of them collide in a hash table, and a message of claims would then
// take 0.2 s. Here no call costs more than one pass over the claims, which takes about 0.1 ms.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "protocol/codec/messages.hpp"

namespace runstone {

class CacheClaims {
 public:
  /// Adds claims, or replaces the claims of the same chunks. Returns false if there are more than
  /// kClaimsPerSessionMax then. Requires strictly ascending keys. Cost: O(claims of the blocks that
  /// have a place for one of them).
  [[nodiscard]] bool add(std::span<const CachedChunk> claims);
  /// Returns the claim of this chunk, or null if there is none. The pointer is valid until the next
  /// change. Cost: O(log claims).
  const CachedChunk* find(const ChunkKey& key) const;
  /// Cost: O(log claims + claims of a block).
  void drop(const ChunkKey& key);
  /// Removes claims outside of the view. Cost: O(claims).
  void keep(const View& view);
  void clear();
  std::size_t count() const { return count_; }

 private:
  // Ascending by key. Never empty.
  using Block = std::vector<CachedChunk>;

  /// Returns the number of the block that has the key or a place for it. Requires that there is a
  /// block.
  std::size_t block_of(const ChunkKey& key) const;
  /// Merges claims into block `at`. Splits it if it becomes too large.
  void merge(std::size_t at, std::span<const CachedChunk> claims);

  std::vector<Block> blocks_;  // ascending by key
  std::size_t count_ = 0;
};

}  // namespace runstone
