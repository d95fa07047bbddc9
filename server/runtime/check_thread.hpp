// CheckThread: reads and verifies the rows of a world while a server runs it, so that damage is
// found while a sound backup still exists. A day after the end of a round the next one begins.
//   - It reads in parts. A part reads for kCheckPartMax, and then ends with the row that it reads,
//     or it reads one table of short rows.
//   - After each part it rests 19 times as long as the part took. So it takes a twentieth of the
//     time of the disk at most.
//   - Each part is a read transaction of its own. So the write-ahead log can be moved into the
//     database between any two parts.
//   - Damage is logged with what to do, and counted. It ends neither the check nor the server.
// It reads the log, the base, the snapshots, the keyframes, players, names, claims, watermarks and
// kept records. It does not read tiles, which are a cache, and files of builds, which are verified
// when they are read. It does not count rows: each start does.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "server/store/store.hpp"

namespace runstone {

/// How long a part reads at most, before it ends with the row that it reads.
inline constexpr std::chrono::milliseconds kCheckPartMax{20};
/// The records of the log, and the chunks, that a part reads at most.
inline constexpr Sequence kCheckPartEdits = 256;
inline constexpr std::size_t kCheckPartChunks = 16;
/// The lines of the log for one round at most. Further damage is counted.
inline constexpr std::uint64_t kCheckLinesMax = 20;

/// How fast a check reads.
struct CheckPace {
  std::int64_t rest_parts = 19;  // a rest is so many times as long as the part before it
  std::chrono::nanoseconds between_rounds = std::chrono::hours(24);
};

class CheckThread {
 public:
  /// Starts the thread. It opens a reader of the world at `place`.
  explicit CheckThread(std::string place, CheckPace pace = {});
  /// Calls stop().
  ~CheckThread() { stop(); }
  CheckThread(const CheckThread&) = delete;
  CheckThread& operator=(const CheckThread&) = delete;

  /// Ends the thread, also while it rests. Waits for the end of the part that it reads. It may be
  /// called again.
  void stop();
  /// Returns how many faults the last round found, or the present one if it has found more. Thread:
  /// any.
  std::uint64_t faults() const { return faults_.load(); }
  /// Returns the bytes of the log of edits, as the last round that read all of it counted them, or
  /// nullopt before the first such round. A record counts as its descriptor and kLogRowBytes.
  /// Thread: any.
  std::optional<std::uint64_t> log_bytes() const;
  /// About what a record takes besides its descriptor: columns and entries of indexes.
  static constexpr std::uint64_t kLogRowBytes = 64;
  /// Returns how many rounds have ended. Thread: any.
  std::uint64_t rounds() const { return rounds_.load(); }
  /// Returns how many parts have ended, in all rounds. Thread: any.
  std::uint64_t parts() const { return parts_.load(); }

 private:
  void run();
  // The functions below return false if the thread must end.

  /// Reads all rows once.
  bool check_all(Store& reader);
  bool check_log(Store& reader);
  bool check_chunks(Store& reader, Store::ChunkRows rows);
  bool check_keyframes(Store& reader);
  /// Calls `load` for 0 up to `count`, in parts.
  bool check_each(std::size_t count, const std::function<StoreResult<void>(std::size_t)>& load);
  /// Calls `part`, notes the error that it fails with, and rests.
  bool check(const std::function<StoreResult<void>()>& part);
  bool rest(std::chrono::nanoseconds time);
  /// Counts and logs damage. An error that may pass is none.
  void note(const StoreError& error);

  const std::string place_;
  const CheckPace pace_;
  std::atomic<std::uint64_t> faults_{0}, rounds_{0}, parts_{0};
  std::atomic<std::int64_t> log_bytes_{-1};  // -1: not counted yet
  std::uint64_t round_faults_ = 0;           // of the present round; of the thread
  std::mutex mutex_;                         // a leaf
  std::condition_variable end_;
  bool stopping_ = false;  // guarded by mutex_
  std::thread thread_;     // starts last, because it uses the members above
};

}  // namespace runstone
