// Checkpointer: writes changed chunks as snapshots and moves the checkpoint, in rounds.
// A round takes the head sequence T and the chunks that are dirty then. In slices it captures each chunk's
// published voxels (loading first those that are not in memory: their stacks need a base), waits until the
// log is durable up to what it captured, and hands them over. Capturing once, instead of taking the newest
// when durable, lets a round end while edits keep coming. With its last slice the checkpoint becomes T, or
// stays below the first edit that only the log has because its chunk is quarantined. One thread (the world
// strand).
#pragma once
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "server/world/authority.hpp"
#include "server/world/world_environment.hpp"

namespace runstone {

struct SnapshotPolicy {
  std::uint64_t edits_max =
      20'000;  // ordered since the last round began: bounds what a start has to replay_onto_stack
  TimeUs interval_us = 30'000'000;  // at the latest, if anything was ordered
  std::size_t slice_chunks = 128;   // captured, loaded and written at a time
};

class Checkpointer {
 public:
  Checkpointer(const SnapshotPolicy& policy, Sequence checkpoint);

  /// Goes on as far as it can; called on each tick, load, durable and saved. `ask_load` is called for chunks
  /// that are absent; it must end in WorldChunks::loaded() or quarantine().
  template <class AskLoad>
  void step(Authority& authority, Sequence durable, const Clocks& now, WorldEnvironment& ports,
            AskLoad&& ask_load) {
    std::vector<ChunkKey> to_load;
    step(authority, durable, now, ports, to_load);
    for (const ChunkKey& key : to_load) ask_load(key);
  }
  /// The slice handed over last is on disk.
  void saved(WorldChunks& chunks);

  /// From now on rounds follow each other until nothing is dirty: the server stops.
  void finish() { finishing_ = true; }
  /// Everything ordered is contained in snapshots, but for quarantined chunks.
  bool is_clean(const Authority& authority) const;

  Sequence checkpoint() const { return checkpoint_; }
  std::uint64_t rounds() const { return rounds_; }

 private:
  void step(Authority& authority, Sequence durable, const Clocks& now, WorldEnvironment& ports,
            std::vector<ChunkKey>& to_load);
  bool is_due(const Authority& authority, const Clocks& now) const;

  struct Round {
    Sequence target = 0;
    std::vector<ChunkKey> keys;
    std::size_t next = 0;           // first key after the slice
    std::vector<ChunkKey> missing;  // of the slice, not captured yet
    std::vector<std::pair<ChunkKey, ChunkPtr>> captured;
  };
  void next_slice();

  SnapshotPolicy policy_;
  Sequence checkpoint_;
  Sequence last_target_;
  std::optional<TimeUs> last_round_us_;
  std::uint64_t rounds_ = 0;
  bool finishing_ = false;
  std::optional<Round> round_;
  struct InFlight {
    std::vector<std::pair<ChunkKey, Version>> chunks;
    Sequence checkpoint = 0;
  };
  std::optional<InFlight> in_flight_;
};

}  // namespace runstone
