// Checkpointer: writes changed chunks as snapshots and moves the checkpoint, in rounds. A round
// covers the chunks that are dirty when it begins, at head sequence T. It handles them in slices:
//   1. It captures each chunk's published voxels. Chunks that are not in memory are loaded first,
//      because their edit stacks need a base.
//   2. It waits until the log is durable up to the newest captured version.
//   3. It hands the captured chunks to the log writer.
// A chunk is captured once, not again when its log is durable, so a round ends while edits keep
// coming. With the last slice the checkpoint becomes T. It stays below the first edit that only the
// log has because its chunk is quarantined. If a round is abandoned, the checkpoint stays where it
// is, and the slices that were written stay valid: the next start replays the other edits.
// Thread: the world strand.
#pragma once
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "server/world/environment/world_environment.hpp"
#include "server/world/environment/world_limits.hpp"
#include "server/world/order/authority.hpp"

namespace runstone {

class Checkpointer {
 public:
  Checkpointer(const SnapshotPolicy& policy, Sequence checkpoint);

  /// Advances the round as far as possible. Call it on each tick and after each load, durable
  /// watermark and saved slice. Returns the absent chunks to load; each load must end in
  /// WorldChunks::loaded() or quarantine().
  [[nodiscard]] std::vector<ChunkKey> step(Authority& authority, Sequence durable,
                                           const Clocks& now, WorldEnvironment& environment);
  /// Reports that the slice handed over last is on disk.
  void saved(WorldChunks& chunks);

  /// Runs one round after the other from now on, until no chunk is dirty. For a server that stops.
  void finish() { finishing_ = true; }
  /// Ends the round under way and begins no other one. A slice that was handed over is still
  /// written, and its chunks may be reported by saved().
  void abandon();
  bool is_abandoned() const { return is_abandoned_; }
  /// Returns true if every ordered edit is contained in snapshots, except those of quarantined
  /// chunks.
  bool is_clean(const Authority& authority) const;

  Sequence checkpoint() const { return checkpoint_; }
  std::uint64_t rounds() const { return rounds_; }

 private:
  bool is_due(const Authority& authority, const Clocks& now) const;

  struct Round {
    Sequence target = 0;
    std::vector<ChunkKey> keys;
    std::size_t next = 0;           // first key after the slice
    std::vector<ChunkKey> missing;  // chunks of the slice that are not captured yet
    std::vector<std::pair<ChunkKey, ChunkPtr>> captured;
  };
  void next_slice();

  SnapshotPolicy policy_;
  Sequence checkpoint_;
  Sequence last_target_;
  std::optional<TimeUs> last_round_us_;
  std::uint64_t rounds_ = 0;
  bool finishing_ = false, is_abandoned_ = false;
  std::optional<Round> round_;
  struct InFlight {
    std::vector<std::pair<ChunkKey, Version>> chunks;
    Sequence checkpoint = 0;
  };
  std::optional<InFlight> in_flight_;
};

}  // namespace runstone
