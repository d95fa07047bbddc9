// Claims: which chunks and tiles this connection has claimed to hold, so that the server sends
// nothing or the missing edits in place of a snapshot. Bound: kClaimsMax claims without an answer.
// One thread.
#pragma once
#include <cstddef>
#include <set>
#include <vector>

#include "client/far/far_tiles.hpp"
#include "client/replica/replica_chunks.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Claims that wait for an answer. Half of what a server accepts, so that the claims for the next
/// view fit beside them.
inline constexpr std::size_t kClaimsMax = kClaimsPerSessionMax / 2;

class Claims {
 public:
  /// Returns the chunks to claim now, ascending: those with a confirmed chunk that are `expected`
  /// and were not claimed on this connection, while fewer than kClaimsMax claims wait for an
  /// answer. The digests are computed from the runs, so that a copy that has drifted is found.
  /// Tiles follow; one that has drifted is not claimed. Cost: O(runs of the claimed chunks and
  /// tiles + chunks + tiles).
  std::vector<CachedChunk> take(const ReplicaChunks& chunks, const FarTiles& tiles);
  /// Call it when the server has answered for the chunk, with any message.
  void answer(const ChunkKey& key) { waiting_.erase(key); }
  /// Call it when the chunk left the view. The chunk may then be claimed again.
  void forget(const ChunkKey& key);
  /// Call it when tiles left the view. The tiles outside of the view may then be claimed again.
  /// Cost: O(claims).
  void forget_tiles_outside(const View& view);
  /// Forgets all claims. Call it when a new connection begins.
  void clear();

  std::size_t waiting_count() const { return waiting_.size(); }

 private:
  std::set<ChunkKey> claimed_;  // on this connection
  std::set<ChunkKey> waiting_;  // of those, without an answer
};

}  // namespace runstone
