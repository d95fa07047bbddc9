// CacheOutbox: confirmed chunks on their way to a cache. Only chunks that the server has vouched
// for on this connection, in the live world, are handed over. Bound: kCacheOutboxMax chunks and
// kCacheOutboxBytesMax bytes that left the view; more are dropped. One thread.
#pragma once
#include <cstddef>
#include <vector>

#include "client/replica/cache_lookup.hpp"
#include "client/replica/replica_chunks.hpp"

namespace runstone {

inline constexpr std::size_t kCacheOutboxMax = 32'768;
inline constexpr std::size_t kCacheOutboxBytesMax = std::size_t{64} << 20;
/// About the most memory of the chunks in view that one call of take() returns.
inline constexpr std::size_t kCacheBatchBytesMax = std::size_t{64} << 20;

class CacheOutbox {
 public:
  /// Collects the chunks that leave the view from now on.
  void enable() { is_enabled_ = true; }
  /// Adds a chunk that leaves the view.
  void add(const TrackedChunk& chunk);
  /// Returns at most `count_max` chunks: first those that left the view, then those in `chunks`
  /// that changed since they were last taken, until these take kCacheBatchBytesMax. `chunks` is
  /// null while the past is shown. Cost: O(chunks).
  std::vector<KeyedChunk> take(ReplicaChunks* chunks, std::size_t count_max);
  void clear() {
    left_.clear();
    bytes_ = 0;
  }

 private:
  bool is_enabled_ = false;
  std::vector<KeyedChunk> left_;
  std::size_t bytes_ = 0;  // of left_
};

}  // namespace runstone
