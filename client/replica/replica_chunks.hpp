// ReplicaChunks: the chunks that a replica tracks, by key. It performs the transitions of their
// states (chunk_state.hpp) and counts chunks by state, and their bytes, so that no count walks the
// view. One thread.
// Cost: O(log chunks) unless stated.
#pragma once
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "client/replica/tracked_chunk.hpp"
#include "common/core/coords.hpp"

namespace runstone {

class ReplicaChunks {
 public:
  using Map = std::map<ChunkKey, TrackedChunk>;

  /// Return null if the chunk is not tracked. The pointer holds until the chunk is erased.
  TrackedChunk* find(const ChunkKey& key);
  const TrackedChunk* find(const ChunkKey& key) const;
  /// Returns the chunk, and true if it was not tracked before: then it is `expected` and empty.
  std::pair<TrackedChunk*, bool> track(const ChunkKey& key);
  /// Erases the chunks of which `leaves` returns true; `leaves` takes a const TrackedChunk&. Cost:
  /// O(chunks).
  template <class Leaves>
  void erase_if(Leaves leaves) {
    for (auto it = chunks_.begin(); it != chunks_.end();) {
      it = leaves(std::as_const(it->second)) ? erase(it) : std::next(it);
    }
  }
  void clear();

  // Transitions, see chunk_state.hpp.
  void answer(TrackedChunk& chunk) { set_state(chunk, after_answer(chunk.state_)); }
  void request(TrackedChunk& chunk) { set_state(chunk, after_request(chunk.state_)); }
  void expect(TrackedChunk& chunk) { set_state(chunk, ChunkState::expected); }
  /// A snapshot becomes the confirmed chunk: no request is open any more.
  void set_current(TrackedChunk& chunk, ChunkPtr confirmed);
  /// Drops what is held. The shown runs stay until the caller hides them.
  void set_unavailable(TrackedChunk& chunk);

  /// Replaces the confirmed chunk, in any state; null drops it.
  void set_confirmed(TrackedChunk& chunk, ChunkPtr confirmed);

  /// Counts the bytes of the chunk again. Call it when its shown runs, its inbox or its pending
  /// edits have changed.
  void recount(TrackedChunk& chunk);
  /// Returns the memory of all chunks.
  std::size_t bytes() const { return bytes_; }

  /// Return numbers of chunks. Cost: O(1).
  std::size_t count(ChunkState state) const { return counts_[static_cast<std::size_t>(state)]; }
  std::size_t vouched_count() const {
    return count(ChunkState::current) + count(ChunkState::repairing);
  }
  std::size_t confirmed_count() const { return confirmed_count_; }
  /// Chunks in the states `requested` and `repairing`, ascending.
  const std::set<ChunkKey>& awaiting() const { return awaiting_; }

  // All chunks, ascending by key.
  Map::iterator begin() { return chunks_.begin(); }
  Map::iterator end() { return chunks_.end(); }
  /// Returns the first chunk whose key is not below `key`.
  Map::iterator lower_bound(const ChunkKey& key) { return chunks_.lower_bound(key); }
  Map::const_iterator begin() const { return chunks_.begin(); }
  Map::const_iterator end() const { return chunks_.end(); }

 private:
  void set_state(TrackedChunk& chunk, ChunkState state);
  Map::iterator erase(Map::iterator it);

  Map chunks_;
  std::array<std::size_t, kChunkStateCount> counts_{};
  std::size_t confirmed_count_ = 0;
  std::size_t bytes_ = 0;
  std::set<ChunkKey> awaiting_;
};

}  // namespace runstone
