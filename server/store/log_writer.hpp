// LogWriter: the one thread that writes a world. It takes batches of records, and jobs for
// snapshots, keyframes, tiles and files of builds, from bounded queues.
//   - Group commit: all batches that were queued during the last fsync become one transaction, and
//     one call of on_durable. A slow disk makes larger groups, and so does
//     commit_interval, because a commit writes some pages of the database however small it is.
//   - Full: has_room() returns false, and the world rejects edits as busy. The queue of jobs does
//     not fill in a server: the checkpointer, the keyframe thread, the tiles and retention each
//     have at most one job under way. So a refused job means that the writer has failed or stopped.
//     The job is not offered again. The file of a build has a place of its own, and may be offered
//     again.
//   - Order: records go before jobs, and a job is written in slices. A record therefore never waits
//     for many chunks.
//   - A full disk, or a database that takes no writes: what was to be written stays queued and is
//     written again once a second, until it can be written. has_room() returns false meanwhile. It
//     also returns false while less space is free than the reserve: the reserve is for what is
//     queued already. Jobs for keyframes, tiles, files of builds and retention end with an error
//     meanwhile, because they hold nothing that the log does not.
//   - A world in a database has an owner (WorldSink::is_owned()). has_room() returns false while
//     another program may own it.
//   - Failure: after any other error nothing more is written, on_failed is called once, and queued
//     batches are dropped. They were never acknowledged. The program must end and recover from the
//     log. A keyframe, a tile or a file that cannot be written ends only its job.
// Threads: append(), change_names(), save_state(), save_snapshots(), save_keyframe(), save_tiles(),
// save_build_file(), fold_log(), give_back_space() and has_room() from any thread. The writer
// thread calls the callbacks, which must return soon. The mutex is a leaf: no callback and no disk
// access happens while it is locked.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/store/world_sink.hpp"

namespace runstone {

/// The room for more edits on the disk of a world.
enum class DiskSpace : std::uint8_t {
  enough,
  low,       // less is free than the reserve: queued edits are written, new ones are rejected
  full,      // a write found no room: it is repeated, and new edits are rejected
  read_only  // the database takes no writes, and it is as for a full disk
};

class LogWriter {
 public:
  struct Limits {
    std::size_t queued_records_max = 65536;  // counted until they are durable
    /// Records per transaction. A single larger batch is one transaction, too.
    std::size_t commit_records_max = 4096;
    /// The least time between the begins of two commits of records, unless the writer stops.
    std::chrono::milliseconds commit_interval{0};
    std::size_t jobs_max = 4;
    std::size_t slice_chunks_max = 32;  // chunks per transaction
    std::uint64_t reserve_bytes = 0;    // below so many free bytes the disk space is low
    /// The time between two looks at the free space, and between two writes to a full disk.
    std::chrono::milliseconds space_interval{1000};
  };
  using SnapshotChunks = std::vector<std::pair<ChunkKey, ChunkPtr>>;
  struct Callbacks {
    std::function<void(Sequence)> on_durable;
    /// Gets the chunks of the job, as they were passed to save_snapshots(), and its checkpoint.
    std::function<void(SnapshotChunks, std::optional<Sequence>)> on_snapshots_saved;
    std::function<void(StoreError)> on_failed;
    /// Reports a change of the disk space, with a reason unless it is enough. The constructor
    /// itself calls it if the space is low at the start.
    std::function<void(DiskSpace, const std::string&)> on_space = {};
    /// Returns the free bytes of the world's disk, or nullopt if they are not known. Empty: nobody
    /// looks at them.
    std::function<std::optional<std::uint64_t>()> free_bytes = {};
    /// Reports that so many changes of names are on disk, the oldest first.
    std::function<void(std::size_t)> on_names_written = {};
  };
  struct Counters {
    std::uint64_t commits = 0, records = 0, snapshots = 0, keyframes = 0;  // since the start
    // Counters of retention since the start: parts, edits that they removed, and the time of the
    // writer.
    std::uint64_t folds = 0, folded_edits = 0, fold_us = 0, fold_us_max = 0;
    std::size_t queued_records = 0;  // now
  };

  /// Starts the thread, which alone writes `world` from now until stop() has returned.
  LogWriter(WorldSink& world, Callbacks callbacks, Limits limits);
  LogWriter(WorldSink& world, Callbacks callbacks)
      : LogWriter(world, std::move(callbacks), Limits{}) {}
  /// Calls stop().
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Returns true if append() may be called with this many records now. Only append() reduces the
  /// room of the queue, so the thread that appends can rely on the answer, even if the disk space
  /// changes before it appends. Returns false after a failure, after stop(), and while another
  /// program may own the world.
  bool has_room(std::size_t records) const;
  /// Returns true also while the disk has no space, otherwise as has_room(): the records then wait
  /// in the queue, and are lost if no space comes before stop().
  bool has_queue_room(std::size_t records) const;
  /// Queues one batch. It becomes durable as a whole. It takes room for its records; a batch of
  /// players only takes room for one record. Requires has_queue_room() for that. A writer that has
  /// failed or stopped drops the batch.
  void append(std::vector<PlayerRow> players, std::vector<EditRecord> records);
  /// Queues changes of names. Requires has_room() for one record. A writer that has failed or
  /// stopped drops them. They take room for one record, and are written before all records that are
  /// queued later.
  void change_names(std::vector<NameChange> names);
  /// Queues the state that is kept besides the log. It takes room for one record. Of several in one
  /// commit the newest is written, after the records, because one of them may have set its clock.
  /// Returns false, and takes nothing, without has_room() or if the writer has failed or stopped.
  bool save_state(SavedState state);
  /// Queues a job. Returns false, and takes nothing, if the queue of jobs is full or the writer has
  /// failed or stopped.
  bool save_snapshots(SnapshotChunks chunks, std::optional<Sequence> checkpoint);
  using JobDone = std::function<void(StoreResult<void>)>;
  /// Queues a job that calls WorldSink::save_keyframe() for each slice of chunks, and passes the
  /// keyframe with the last one. The writer thread calls `done` when all of it is on disk, or has
  /// failed. Returns false as save_snapshots(); `done` is not called then.
  bool save_keyframe(SnapshotChunks chunks, std::optional<Keyframe> keyframe, JobDone done);
  /// Queues a job that calls WorldSink::save_tiles() for each slice of tiles. `done` and the result
  /// are as for save_keyframe().
  bool save_tiles(SnapshotChunks tiles, std::uint32_t rules, JobDone done);
  /// Queues a job that calls WorldSink::save_build_part() for each part of the file of a build. `done`
  /// is as for save_keyframe(). The file must not change. Returns false also if another file is being
  /// written.
  bool save_build_file(std::uint64_t content, std::shared_ptr<const Bytes> file, JobDone done);
  /// Queues a job that calls WorldSink::remove_build_file() for a file that was written and whose
  /// build is not added. Its errors are ignored, because the next start removes the file too. At most
  /// one such job follows a file, so they are not bounded otherwise. A writer that has failed or
  /// stopped drops it.
  void remove_build_file(std::uint64_t content);
  /// Queues a job that calls WorldSink::fold_log(). `done` is as for save_keyframe(). Returns false
  /// as save_snapshots() does.
  bool fold_log(LogFold fold, JobDone done);
  /// Queues a job that calls WorldSink::give_back_space(). `done` gets true if there is more of it.
  /// Returns false as save_snapshots() does.
  using SpaceDone = std::function<void(StoreResult<bool>)>;
  bool give_back_space(std::uint32_t pages, SpaceDone done);
  /// Writes everything that is queued, calls the callbacks, and ends the thread. If the disk is
  /// full, it tries once more and gives up: Counters::queued_records are the records that are lost.
  /// Snapshots without room do not keep it from writing records.
  /// It may be called again, but not from a callback.
  void stop();

  Counters counters() const;
  /// Returns the bytes of memory that the queued records take, until they are durable.
  std::size_t queued_bytes() const { return bytes_taken_.load(); }

 private:
  struct Batch {
    std::vector<NameChange> names;
    std::vector<PlayerRow> players;
    std::vector<EditRecord> records;
    std::optional<SavedState> state;
    std::size_t room = 0;   // of queued_records_max that the batch takes
    std::size_t bytes = 0;  // of memory that the records take
  };
  struct Job {
    SnapshotChunks chunks;
    std::optional<Sequence> checkpoint;
    std::size_t written = 0;                      // chunks or parts of the file that are on disk
    std::optional<Keyframe> keyframe;             // only in a job for a keyframe
    JobDone done;                                 // in a job for a keyframe or for tiles
    std::optional<std::uint32_t> tile_rules;      // only in a job for tiles
    std::shared_ptr<const Bytes> file = nullptr;  // only in a job for the file of a build
    std::uint64_t content = 0;
    bool removes_file = false;                   // only in a job that removes the file of a build
    std::optional<LogFold> fold = std::nullopt;  // only in a job of retention
    std::optional<std::uint32_t> pages_back = std::nullopt;  // only in a job that gives space back
    std::shared_ptr<bool> has_more_space = nullptr;          // its result
    std::size_t size() const;
    bool is_of_file() const { return file != nullptr || removes_file; }
    bool is_over() const { return written == size(); }
  };

  /// Requires mutex_.
  bool is_room_in_queue(std::size_t records) const;
  bool queue(Job job);
  /// Returns false, and takes nothing, if the writer has failed or stopped.
  bool queue(Batch batch);
  void run();
  /// Waits for work and takes it: a group unless one is left to write, and a job unless one is
  /// under way. Returns false if the writer stops and nothing is left. May return without work, so
  /// that the free space is looked at again.
  bool take_work(Batch& group, std::optional<Job>& job);
  /// Moves batches from the queue into one. Requires that the mutex is locked.
  Batch take_group();
  /// Writes the group and empties it.
  StoreResult<void> write(Batch& group);
  /// Writes the next slice of a job. The last slice moves the checkpoint, or writes the keyframe.
  StoreResult<void> write_slice(Job& job);
  /// Writes the next part of the file of a build, and calls the job's `done` after the last one.
  void write_part(Job& job);
  void remove_file(Job& job);
  void write_fold(Job& job);
  void write_space(Job& job);
  /// Looks at the free space, unless it was done less than space_interval ago.
  void check_space();
  void set_space(DiskSpace space, const std::string& reason);
  /// Waits before the next write to a full disk. `group` is what is left of the records. If the
  /// writer stops, it does not wait: it returns false if records found no room, and drops the
  /// snapshots otherwise.
  bool wait_for_room(const StoreError& error, const Batch& group, std::optional<Job>& job);
  /// Ends the jobs for keyframes and tiles, `job` included, with an error.
  void end_optional_jobs(const StoreError& error, std::optional<Job>& job);
  /// Ends the writer. `job` is the one that is being written, if any.
  void fail(const StoreError& error, std::optional<Job>& job);

  WorldSink& world_;
  const Callbacks callbacks_;
  const Limits limits_;
  std::atomic<std::size_t> bytes_taken_{0};  // of memory, by records queued or being written
  TimeUs looked_us_ = 0;  // when the free space was looked at; only for check_space()
  std::chrono::steady_clock::time_point group_due_;  // of the next commit; only for take_work()
  mutable std::mutex mutex_;
  std::condition_variable work_;
  // mutex_ guards all members from here on.
  std::deque<Batch> batches_;
  std::deque<Job> jobs_;
  std::size_t room_taken_ = 0;   // by batches queued or being written
  bool job_is_running_ = false;  // the writer thread has a job that is not in jobs_
  bool has_file_job_ = false;    // one that writes the file of a build is queued or running
  std::size_t file_jobs_ = 0;    // that write or remove files, queued or running
  bool stopping_ = false, failed_ = false;
  DiskSpace space_ = DiskSpace::enough;
  Counters counters_;
  // The constructor starts the thread last, when all others exist.
  std::thread thread_;
};

}  // namespace runstone
