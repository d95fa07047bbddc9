// WorldChunks: every chunk that the world strand knows: its version, its edit stack and, if it is
// in memory, its published voxels. Invariants:
//   - The version is that of the last ordered edit that touches the chunk, in memory or not.
//   - A resident chunk has an empty stack between commits. An absent chunk keeps in its stack every
//     edit above its saved version, in order.
//   - A chunk is evicted only when its saved version is its version, so a load finds all of its
//     edits.
//   - stack_bytes() is the sum of `bytes` of the edits on all stacks.
// Memory: an edited chunk keeps a small entry (its version) until the server stops. A chunk at
// version (0, 0) is removed with its voxels.
// Thread: the world strand.
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
#include "server/interest/chunk_hash_map.hpp"

namespace runstone {

enum class Residency {
  absent,    // not in memory
  loading,   // a load is under way
  resident,  // in memory and published
  // It could not be loaded. Its edits are ordered and logged, but it is sent to nobody and never
  // regenerated. Sessions get "chunk unavailable".
  quarantined,
};

class WorldChunks {
 public:
  explicit WorldChunks(std::int32_t edge) : edge_(edge) {}

  /// Sets the version of a chunk's snapshot. Requires that no replay_onto_stack() came before.
  void set_saved(const ChunkKey& key, Version version);
  /// Puts a logged edit back on the stack of a chunk it touches, unless the snapshot contains it.
  /// Requires log order. `bytes`: the memory that the edit takes on this stack.
  void replay_onto_stack(const ChunkKey& key, Version version, const EditDescriptor& edit,
                         std::size_t bytes);

  /// Puts an ordered edit on top of the chunk's stack and raises its version. Returns the sequence
  /// of its version before. `bytes`: the memory that the edit takes on this stack.
  Sequence push(const ChunkKey& key, Version version, const EditDescriptor& edit,
                std::size_t bytes);
  /// Applies a resident chunk's stack to a private copy in one sweep and publishes the copy.
  /// Cost: O(runs + stack).
  void publish(const ChunkKey& key);

  Residency residency(const ChunkKey& key) const;
  /// Returns the published chunk, or null unless it is resident.
  ChunkPtr find(const ChunkKey& key) const;
  Version version(const ChunkKey& key) const;
  /// Returns the resident chunks that were ever edited, ascending. Cost: O(entries).
  std::vector<std::pair<ChunkKey, ChunkPtr>> edited() const;
  std::size_t stack_size(const ChunkKey& key) const;
  /// Makes an absent chunk loading. Returns true if it was absent; the caller must load it then.
  bool begin_load(const ChunkKey& key);
  /// Applies the stack above its version to a loaded chunk and publishes it. Fails and quarantines
  /// the chunk if its size or version contradicts the log. Ignores chunks that are not loading.
  Result<void, std::string> loaded(const ChunkKey& key, Chunk chunk);
  /// Quarantines a chunk whose load failed, and drops its stack. A later start reads it from the
  /// log again.
  void quarantine(const ChunkKey& key);
  /// Makes a chunk without users a candidate for eviction.
  void released(const ChunkKey& key);
  /// Evicts clean chunks without users, longest unused first, until resident_bytes() is
  /// at most `bytes_max`. Cost: O(steps_max).
  void evict(std::size_t bytes_max, std::size_t steps_max,
             const std::function<bool(const ChunkKey&)>& is_used);

  /// Returns the chunks that were edited since their snapshot, ascending.
  const std::set<ChunkKey>& dirty() const { return dirty_; }
  void mark_saved(const ChunkKey& key, Version version);
  /// Reports that another program has saved the chunks with all edits up to this sequence. Cost:
  /// O(dirty chunks).
  void saved_up_to(Sequence seq);
  /// Returns the lowest sequence that only the log has because its chunk is quarantined, or nullopt
  /// if there is none. A checkpoint must stay below it, so that a start after a repair replays
  /// those edits.
  std::optional<Sequence> first_quarantined_edit() const;

  /// Returns the depths of the edit stacks that were applied since the start.
  const StackDepths& stack_depths() const { return stack_depths_; }
  std::size_t resident_count() const { return resident_count_; }
  /// Returns the memory that the resident chunks take, what the heap adds to each included.
  std::size_t resident_bytes() const { return resident_bytes_; }
  /// Returns the bytes of the edits on all stacks, and of the stacks.
  std::size_t stack_bytes() const { return stack_bytes_; }

 private:
  struct Entry {
    Residency residency = Residency::absent;
    bool is_candidate = false;  // is in idle_
    Version version, saved;
    ChunkPtr published;
    std::vector<EditDescriptor> stack;
    std::vector<Sequence> stack_seqs;  // of the edits in `stack`
    std::size_t stack_bytes = 0;
    std::size_t resident_bytes = 0;  // while it is resident
  };
  /// Returns the memory that a resident chunk takes: the entry, the voxels and the room that its
  /// stack keeps.
  static std::size_t bytes_of(const Entry& e);
  Entry* entry(const ChunkKey& key);
  const Entry* entry(const ChunkKey& key) const;
  /// Applies the stack above the chunk's version and publishes the chunk.
  void apply_and_publish(const ChunkKey& key, Entry& e, Chunk chunk);
  void unpublish(Entry& e);
  void clear_stack(Entry& e);

  std::int32_t edge_;
  ChunkHashMap<Entry> entries_;
  std::set<ChunkKey> dirty_;
  // The first edit of each quarantined chunk that is not in a snapshot.
  std::unordered_map<ChunkKey, std::optional<Sequence>, ChunkKeyHash> quarantined_;
  std::deque<ChunkKey> idle_;
  std::size_t resident_count_ = 0, resident_bytes_ = 0, stack_bytes_ = 0;
  StackDepths stack_depths_;
  ApplyScratch scratch_;
};

}  // namespace runstone
