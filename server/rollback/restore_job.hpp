// RestoreJob: takes a selection back, chunk by chunk, while players go on building.
//   - A worker plans each chunk from the durable log. The world strand writes the plan if the chunk
//     still has the version of the plan.
//   - If the chunk has changed meanwhile, it is planned again. After kCollisionsMax collisions its
//     edits are masked (restore_paste.hpp): they leave alone every voxel that was changed since,
//     and are written without that comparison.
//   - An edit that the author may not make, for example on protected ground, is left out.
//   - Each step writes a slice of some chunks, so that other players' edits come in between. Fills
//     that continue each other are one edit. A slice is cut short by the room in the log, and by the budget of the payer if the order names
//     one. The rest goes into later slices.
// The edits are ordinary ones: ordered, logged and sent. A job that is cancelled, or whose server
// stops, leaves a world in which some chunks are restored and the others are not. The job itself
// can be undone like other edits, by its author and client instance.
// Threads: the world strand. It uses no clock, disk or thread.
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
  AuthorId author = 0;  // of the edits that the job writes; 0: the server
  ClientInstance instance = 0;
  ClientSequence first_seq = 1;  // of the first edit; later ones count up
  AuthorId payer = 0;            // as for Changes::order_edits()
  Cause cause = Cause::rollback;
  Sequence subject = 0;  // of each edit; 0: the newest selected edit of its chunk
  std::shared_ptr<const Selection> selection;
};

/// An order to a worker.
struct RestoreWork {
  std::shared_ptr<const Selection> selection;
  struct Item {
    ChunkKey key;
    bool is_careful = false;  // masked edits
  };
  std::vector<Item> items;
  Sequence end = 0;  // the last edit to be read; durable
};

/// A worker's answer for one chunk.
struct RestoredChunk {
  ChunkKey key;
  Version version;
  Sequence subject = 0;               // newest selected edit in the chunk
  std::uint64_t voxels = 0;           // that the edits change
  std::vector<EditDescriptor> edits;  // disjoint; empty: nothing to change
  std::string error;                  // why the chunk cannot be planned; empty if it can
};
/// Does the work. Chunks that are no longer wanted come back with an error. Thread: the one that
/// owns the reader.
std::vector<RestoredChunk> restore_chunks(WorldReader& reader, const Generator& generator,
                                          const RestoreWork& work,
                                          const ShouldContinue& should_continue = {});

struct RestoreLimits {
  std::size_t slice_chunks = 1024;     // written per step
  std::size_t slice_work = 64 * 1024;  // edit_work() written per step; a single chunk may have more
  std::size_t work_chunks = 512;       // in one order to a worker
};

class RestoreJob {
 public:
  enum class State { applying, done, cancelled, failed };
  static constexpr int kCollisionsMax = 3;
  /// The number of times that a chunk may be skipped because its newest edit is not on disk yet.
  /// Then it counts as a chunk that always collides: a stream of edits could otherwise hold the job
  /// for ever.
  static constexpr int kPassesMax = 32;

  explicit RestoreJob(RestoreOrder order, RestoreLimits limits = {});

  /// Returns the next work for a worker, or nullopt while some is under way, while a whole slice is
  /// planned, or if none can begin yet.
  /// Call computed() or work_failed() with its outcome.
  std::optional<RestoreWork> next_work(const WorldServer& world);
  void computed(std::vector<RestoredChunk> chunks);
  /// Ends the job as failed: the work could not be done at all.
  void work_failed(std::string what);
  /// Writes a slice, after a commit of all queued edits. Call it on each tick.
  void step(WorldServer& world, const Clocks& now);
  /// Ends the job. Edits that are written stay. Does nothing if the job has ended.
  void cancel();

  State state() const { return state_; }
  const RestoreOrder& order() const { return order_; }
  struct Progress {
    std::size_t chunks = 0, chunks_done = 0;  // done: written, or without changes
    std::size_t chunks_changed = 0;           // written
    std::size_t chunks_failed = 0;
    std::uint64_t edits = 0, voxels = 0;  // written
    std::uint64_t collisions = 0;         // plans of an older version of their chunk
    std::uint64_t edits_refused = 0;      // that the author may not make
    std::string refusal;                  // the reason for the last of them
    Sequence first = 0, last = 0;         // of the edits written; 0 if there are none
    std::string error;                    // the first one
    std::string waits_for;                // the limit that cut the last slice short, or empty
  };
  const Progress& progress() const { return progress_; }

 private:
  void end_if_done();
  /// Removes the edits of the chunk that the author may not make.
  void leave_protected(RestoredChunk& chunk, const WorldServer& world);
  /// Counts the first `count` edits of the slice, which are written, and puts the others back to be
  /// written next.
  void take_written(std::vector<RestoredChunk> slice, std::size_t count, const WorldServer& world);
  bool is_careful(const ChunkKey& key) const;
  std::size_t work_of(const RestoredChunk& chunk) const;

  RestoreOrder order_;
  RestoreLimits limits_;
  State state_ = State::applying;
  std::deque<ChunkKey> waiting_;       // to be planned
  bool is_working_ = false;            // a worker plans some
  std::deque<RestoredChunk> planned_;  // to be written
  std::set<ChunkKey> begun_;           // chunks with some edits written, but not all
  std::map<ChunkKey, int> collisions_, passes_;
  Sequence last_end_ = 0;  // durable at the last next_work()
  ClientSequence next_seq_;
  Progress progress_;
};

}  // namespace runstone
