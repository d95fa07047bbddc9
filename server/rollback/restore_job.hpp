// RestoreJob: takes a selection back while people play, chunk by chunk. Each chunk is planned on a worker from
// the durable log; the world strand writes the plan only if the chunk still stands at the version that it was
// made for. If somebody has built there meanwhile, the chunk is planned again; after kCollisionsMax times its
// edits are masked so that they leave alone whatever was changed since (restore_paste.hpp), and go in without
// that comparison. A slice of a few chunks is written per step, so other people's edits come in between.
// As much of a slice is written as the log has room for, and as the author can pay for if the order says that
// somebody pays; the rest goes into later ones.
// What is written is ordinary edits: ordered, logged, sent. So a job that is cancelled, or whose server
// stops, leaves a world in which some chunks are restored and the others are not; and the job itself can be
// taken back like any other edits, by its author and client instance.
// One thread (the world strand); no clock, disk or thread in it.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/rollback/selection.hpp"
#include "server/store/world_reader.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

struct RestoreOrder {
  AuthorId author = 0;  // of the edits it writes; 0: the server itself
  ClientInstance instance = 0;
  ClientSequence first_seq = 1;  // of its edits, which count on from there
  AuthorId payer = 0;            // as for WorldServer::order_server_edits()
  Cause cause = Cause::rollback;
  Sequence subject = 0;  // of each edit; 0: the newest selected edit of its chunk
  std::shared_ptr<const Selection> selection;
};

/// What a worker is asked for.
struct RestoreWork {
  std::shared_ptr<const Selection> selection;
  struct Item {
    ChunkKey key;
    bool is_careful = false;  // masked edits
  };
  std::vector<Item> items;
  Sequence end = 0;  // last edit to be looked at; durable
};

/// What a worker answers for one chunk.
struct RestoredChunk {
  ChunkKey key;
  Version version;
  Sequence subject = 0;               // newest selected edit in the chunk
  std::uint64_t voxels = 0;           // that the edits change
  std::vector<EditDescriptor> edits;  // disjoint; empty: nothing to change
  std::string error;                  // not empty: the chunk cannot be planned, and why
};
/// Does the work. Any thread that owns the reader. Chunks that are not wanted any more come back with an error.
std::vector<RestoredChunk> restore_chunks(WorldReader& reader, const Generator& generator,
                                          const RestoreWork& work, const GoesOn& goes_on = {});

struct RestoreLimits {
  std::size_t slice_chunks = 16;         // written per step
  std::uint64_t slice_voxels = 200'000;  // likewise; a single chunk may have more
  std::size_t work_chunks = 32;          // planned at a time
};

class RestoreJob {
 public:
  enum class State { applying, done, cancelled, failed };
  static constexpr int kCollisionsMax = 3;
  /// How often a chunk may be passed by because its newest edit is not on disk yet; then it counts as one that
  /// collides always, or a stream of edits could hold the job for ever.
  static constexpr int kPassesMax = 32;

  explicit RestoreJob(RestoreOrder order, RestoreLimits limits = {});

  /// The next work for a worker; nothing while some is under way or none can begin yet. computed() answers it.
  std::optional<RestoreWork> next_work(const WorldServer& world);
  void computed(std::vector<RestoredChunk> chunks);
  /// The work could not be done at all: the job fails.
  void work_failed(std::string what);
  /// Writes a slice. Call it on each tick; it commits what is queued first.
  void step(WorldServer& world, const Clocks& now);
  /// What is written stays. Nothing after the end.
  void cancel();

  State state() const { return state_; }
  const RestoreOrder& order() const { return order_; }
  struct Progress {
    std::size_t chunks = 0, chunks_done = 0;  // done: written, or nothing to change
    std::size_t chunks_changed = 0;           // written
    std::size_t chunks_failed = 0;
    std::uint64_t edits = 0, voxels = 0;  // written
    std::uint64_t collisions = 0;         // plans that came too late
    Sequence first = 0, last = 0;         // of the edits written; 0 without one
    std::string error;                    // the first
    std::string waits_for;                // the limit that cut the last slice short; empty: none
  };
  const Progress& progress() const { return progress_; }

 private:
  void end_if_done();
  /// The first `count` edits of the slice are written: counts them, and puts the others back to be written next.
  void take_written(std::vector<RestoredChunk> slice, std::size_t count, const WorldServer& world);
  bool is_careful(const ChunkKey& key) const;

  RestoreOrder order_;
  RestoreLimits limits_;
  State state_ = State::applying;
  std::deque<ChunkKey> waiting_;       // to be planned
  bool is_working_ = false;            // a worker plans some
  std::deque<RestoredChunk> planned_;  // to be written
  std::set<ChunkKey> begun_;           // of which some edits are written, but not all
  std::map<ChunkKey, int> collisions_, passes_;
  ClientSequence next_seq_;
  Progress progress_;
};

}  // namespace runstone
