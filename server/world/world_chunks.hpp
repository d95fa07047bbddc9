// WorldChunks: every chunk the world strand knows: its version, its edit stack and, if it is in memory, its
// published voxels. Invariants:
//   - the version is that of the last ordered edit that touches the chunk, whether its voxels are here or
//   not;
//   - a resident chunk has an empty stack between commits; an absent one keeps in its stack every edit above
//   its
//     saved version, in order;
//   - a chunk is evicted only when its saved version is its version, so a load finds all of it.
// Memory: edited chunks keep a small entry for ever (their version); chunks at version (0, 0) leave with
// their voxels. One thread (the world strand).
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/apply/stack_depths.hpp"
#include "common/runs/chunk.hpp"
#include "server/interest/chunk_key_hash.hpp"

namespace runstone {

/// absent: not in memory. loading: asked for. resident: published. quarantined: it could not be loaded; its
/// edits are ordered and logged, but nobody gets it (they are told) and it is never made anew.
enum class Residency { absent, loading, resident, quarantined };

class WorldChunks {
 public:
  explicit WorldChunks(std::int32_t edge) : edge_(edge) {}

  // ---- start
  /// Says at which version a chunk's snapshot stands. Before any replay_onto_stack().
  void set_saved(const ChunkKey& key, Version version);
  /// Puts a logged edit back on the stack of a chunk it touches, unless the snapshot has it. In log order.
  void replay_onto_stack(const ChunkKey& key, Version version, const EditDescriptor& edit);

  // ---- order
  /// Puts an ordered edit on top of the chunk's stack and moves its version. Returns the sequence it stood
  /// at.
  Sequence push(const ChunkKey& key, Version version, const EditDescriptor& edit);
  /// Applies a resident chunk's stack in one sweep to a private copy and publishes that. O(runs + stack).
  void publish(const ChunkKey& key);

  // ---- memory
  Residency residency(const ChunkKey& key) const;
  /// Null unless resident.
  ChunkPtr find(const ChunkKey& key) const;
  Version version(const ChunkKey& key) const;
  /// Resident chunks that were ever edited, ascending. O(entries).
  std::vector<std::pair<ChunkKey, ChunkPtr>> edited() const;
  std::size_t stack_size(const ChunkKey& key) const;
  /// Absent becomes loading; true if the caller has to ask for it.
  bool begin_load(const ChunkKey& key);
  /// Takes what was asked for, applies the stack above its version and publishes it. A chunk that does not
  /// fit what the log says (size, version) is quarantined; the text says why. Chunks not asked for are
  /// ignored.
  std::optional<std::string> loaded(const ChunkKey& key, Chunk chunk);
  /// The load failed: quarantined from now on. The stack goes: only a later start can use it, from the log.
  void quarantine(const ChunkKey& key);
  /// Marks a chunk that nobody uses as a candidate for eviction.
  void released(const ChunkKey& key);
  /// Evicts clean chunks that nobody uses, longest unused first, until the voxels fit `bytes_max`. Looks at
  /// `steps_max` chunks at most.
  void evict(std::size_t bytes_max, std::size_t steps_max,
             const std::function<bool(const ChunkKey&)>& is_used);

  // ---- snapshots
  /// Chunks edited since their snapshot, ascending.
  const std::set<ChunkKey>& dirty() const { return dirty_; }
  void mark_saved(const ChunkKey& key, Version version);
  /// Lowest sequence that only the log has because its chunk is quarantined; nothing if there is none. A
  /// checkpoint must stay below it, so that a start after a repair stacks those edits again.
  std::optional<Sequence> first_quarantined_edit() const;

  /// Of all chunks published since the start.
  const StackDepths& stack_depths() const { return stack_depths_; }
  std::size_t resident_count() const { return resident_count_; }
  std::size_t resident_bytes() const { return resident_bytes_; }
  std::size_t quarantined_count() const { return quarantined_.size(); }

 private:
  struct Entry {
    Residency residency = Residency::absent;
    bool is_candidate = false;  // in idle_
    Version version, saved;
    ChunkPtr published;
    std::vector<EditDescriptor> stack;
    std::vector<Sequence> stack_seqs;  // of the edits in `stack`
  };
  Entry* entry(const ChunkKey& key);
  const Entry* entry(const ChunkKey& key) const;
  void settle(const ChunkKey& key, Entry& e, Chunk chunk);
  void unpublish(Entry& e);

  std::int32_t edge_;
  std::unordered_map<ChunkKey, Entry, ChunkKeyHash> entries_;
  std::set<ChunkKey> dirty_;
  std::unordered_map<ChunkKey, std::optional<Sequence>, ChunkKeyHash>
      quarantined_;  // first edit not in a snapshot
  std::deque<ChunkKey> idle_;
  std::size_t resident_count_ = 0, resident_bytes_ = 0;
  StackDepths stack_depths_;
  ApplyScratch scratch_;
};

}  // namespace runstone
