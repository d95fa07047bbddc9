// LogWriter: the one thread that writes a world. It takes batches of records, snapshot and keyframe jobs from bounded
// queues, commits everything that queued while the last fsync ran as one transaction (group commit), and
// tells when it is durable. Needs no clock: a slow disk makes larger groups, a fast one smaller groups. Full:
// has_room() turns false, and the world rejects edits as busy; a snapshot job that finds no room is refused,
// and the world offers its chunks again later. Records go before snapshots, and a job is written in slices,
// so that durability never waits behind many chunks. Failure: after the first error nothing more is written,
// on_failed is called once, and what was queued is dropped: it was never acknowledged. The program has to end
// and recover from the log. A keyframe that cannot be written ends nothing: the log says all that it would have. Threads: append(), save_snapshots(), save_keyframe() and has_room() from any thread; callbacks
// come from the writer thread and must return soon. The mutex inside is a leaf: no callback and no disk
// access happens while it is held.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "server/store/world_sink.hpp"

namespace runstone {

class LogWriter {
 public:
  struct Limits {
    std::size_t queued_records_max = 65536;  // counted until they are durable
    std::size_t commit_records_max =
        4096;  // per transaction; a single larger batch is still one transaction
    std::size_t jobs_max = 4;
    std::size_t slice_chunks_max = 32;  // chunks per transaction
  };
  using SnapshotChunks = std::vector<std::pair<ChunkKey, ChunkPtr>>;
  struct Callbacks {
    std::function<void(Sequence)> on_durable;
    /// The job's chunks, as they were handed over, and its checkpoint.
    std::function<void(SnapshotChunks, std::optional<Sequence>)> on_snapshots_saved;
    std::function<void(StoreError)> on_failed;
  };
  struct Counters {
    std::uint64_t commits = 0, records = 0, snapshots = 0, keyframes = 0;  // since the start
    std::size_t queued_records = 0;                                        // now
  };

  /// Starts the thread, which alone uses `world` from now until stop() has returned.
  LogWriter(WorldSink& world, Callbacks callbacks, Limits limits);
  LogWriter(WorldSink& world, Callbacks callbacks)
      : LogWriter(world, std::move(callbacks), Limits{}) {}
  /// stop().
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Whether append() may be given this many records now. Only appending makes it false, so the one thread
  /// that appends may rely on a true answer. False after a failure and after stop().
  bool has_room(std::size_t records) const;
  /// Queues one batch; it becomes durable as a whole. Requires has_room(records.size()), or has_room(1) if
  /// there are none, unless the writer has failed or stopped, when the batch is dropped. Players ride along
  /// and take no room; a batch of players alone takes that of one record.
  void append(std::vector<PlayerRow> players, std::vector<EditRecord> records);
  /// Queues a job. False if the queue of jobs is full (or the writer has failed or stopped): nothing was
  /// taken.
  bool save_snapshots(SnapshotChunks chunks, std::optional<Sequence> checkpoint);
  using KeyframeDone = std::function<void(StoreResult<void>)>;
  /// Queues a job that calls WorldSink::save_keyframe(), in slices, the keyframe with the last one. `done` is called from the
  /// writer thread when it is on disk or cannot be. False as above; `done` is not called then.
  bool save_keyframe(SnapshotChunks chunks, std::optional<Keyframe> keyframe, KeyframeDone done);
  /// Writes everything that is queued, with all its callbacks, then ends the thread. May be called again. Not
  /// from a callback.
  void stop();

  Counters counters() const;

 private:
  struct Batch {
    std::vector<PlayerRow> players;
    std::vector<EditRecord> records;
    std::size_t room = 0;  // what it takes of queued_records_max
  };
  struct Job {
    SnapshotChunks chunks;
    std::optional<Sequence> checkpoint;
    std::size_t written = 0;  // chunks of the slices that are on disk
    // Of a keyframe's job, which has `done`.
    std::optional<Keyframe> keyframe;
    KeyframeDone done;
    bool is_over() const { return written == chunks.size(); }
  };

  bool queue(Job job);
  void run();
  /// Moves batches from the queue into one. Requires the mutex.
  Batch take_group();
  StoreResult<void> write(const Batch& group);
  /// Writes the next slice of a job; the last one moves the checkpoint, or writes the keyframe.
  StoreResult<void> write_slice(Job& job);
  /// `job`: the one in hand, if any.
  void fail(const StoreError& error, Job* job);

  WorldSink& world_;
  const Callbacks callbacks_;
  const Limits limits_;
  mutable std::mutex mutex_;
  std::condition_variable work_;
  // Guarded by mutex_ from here on.
  std::deque<Batch> batches_;
  std::deque<Job> jobs_;
  std::size_t room_taken_ = 0;  // by batches queued or being written
  bool job_in_hand_ = false;    // the writer thread has taken a job out of the queue
  bool stopping_ = false, failed_ = false;
  Counters counters_;
  // The thread starts last and sees everything above.
  std::thread thread_;
};

}  // namespace runstone
