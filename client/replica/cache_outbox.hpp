// CacheOutbox: confirmed chunks on their way to a cache. Only chunks that the server has vouched
// for on this connection, in the live world, are handed over. A round of calls of take() visits
// each chunk in view once, so a chunk that changes all the time is handed over once a round.
// Bound: kCacheOutboxMax chunks and kCacheOutboxBytesMax bytes that left the view; more are
// dropped. One thread.
#pragma once
#include <cstddef>
#include <optional>
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
  /// null while the past is shown; this ends the round. The result is empty only if no chunk is to
  /// be cached. Cost: O(chunks).
  std::vector<KeyedChunk> take(ReplicaChunks* chunks, std::size_t count_max);
  /// Returns true if the last call of take() ended a round: the next one begins at the first chunk.
  bool is_round_over() const { return left_.empty() && !next_; }
  void clear() {
    left_.clear();
    bytes_ = 0;
    next_.reset();
  }

 private:
  std::vector<KeyedChunk> take_left(std::size_t count_max);
  /// Appends the changed chunks from next_ on, and sets next_.
  void take_changed(ReplicaChunks& chunks, std::size_t count_max, std::vector<KeyedChunk>& out);

  bool is_enabled_ = false;
  std::optional<ChunkKey> next_;  // the chunk at which the round continues; nullopt: a new round
  std::vector<KeyedChunk> left_;
  std::size_t bytes_ = 0;  // of left_
};

}  // namespace runstone
