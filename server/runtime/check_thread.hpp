// CheckThread: reads and verifies the rows of a world while a server runs it, so that damage is
// found while a sound backup still exists. It begins anew each day.
//   - After each part it rests 19 times as long as the part took. So it takes a twentieth of the
//     time of the disk at most.
//   - Damage is logged with what to do, and counted. It ends neither the check nor the server.
// It reads the log, the base, the snapshots, the keyframes, players, names, claims, watermarks and
// kept records. It does not read tiles, which are a cache, and files of builds, which are
// verified when they are read.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "server/store/store_error.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

class CheckThread {
 public:
  /// Starts the thread. It opens a reader of the world at `place`.
  explicit CheckThread(std::string place);
  /// Calls stop().
  ~CheckThread() { stop(); }
  CheckThread(const CheckThread&) = delete;
  CheckThread& operator=(const CheckThread&) = delete;

  /// Ends the thread. Waits for the part that is read at most. It may be called again.
  void stop();
  /// Returns how many faults the last round found, or this one if it has found more. Thread: any.
  std::uint64_t faults() const { return faults_.load(); }
  /// Returns the bytes of the log of edits as the last round counted them, or nullopt before the
  /// first one. A record counts as its descriptor and kLogRowBytes. Thread: any.
  std::optional<std::uint64_t> log_bytes() const;
  /// About what a record takes besides its descriptor: columns and entries of indexes.
  static constexpr std::uint64_t kLogRowBytes = 64;
  /// Returns how often all rows were read. Thread: any.
  std::uint64_t rounds() const { return rounds_.load(); }

 private:
  void run();
  /// Reads all rows once. Returns false if the thread must end.
  bool check_all(WorldReader& reader);
  bool check_log(WorldReader& reader);
  bool check_chunks(WorldReader& reader);
  /// Calls `part`, counts and logs what it fails with, and rests. Returns false if the thread must
  /// end.
  bool check(const std::function<StoreResult<void>()>& part);
  /// Waits. Returns false if the thread must end.
  bool rest(std::chrono::nanoseconds time);

  const std::string place_;
  std::atomic<std::uint64_t> faults_{0}, rounds_{0};
  std::atomic<std::int64_t> log_bytes_{-1};  // -1: not counted yet
  std::uint64_t round_faults_ = 0;           // of the present round; of the thread
  std::mutex mutex_;                         // a leaf
  std::condition_variable end_;
  bool stopping_ = false;  // guarded by mutex_
  std::thread thread_;     // starts last, because it uses the members above
};

}  // namespace runstone
