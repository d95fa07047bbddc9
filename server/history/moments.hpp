// Moments: a cache of past worlds, ready to make chunks of them. It keeps the worlds that were used
// last, because users who move through time come back to them. Each has a reader of its own. It
// blocks on the disk.
// Threads: any. A world makes one chunk at a time.
#pragma once
#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "server/history/world_at.hpp"

namespace runstone {

class Moments {
 public:
  /// The number of edits that opening a moment may have to read and keep. With keyframes there are
  /// about 32,768.
  static constexpr Sequence kEditsMax = 1'000'000;

  /// `generator` must outlive the object. Keeps up to `kept_max` moments. Requires kept_max >= 1.
  Moments(std::string place, const Generator& generator, std::size_t kept_max = 4)
      : place_(std::move(place)), generator_(generator), kept_max_(kept_max) {}

  /// Opens the moment after the edit with this sequence, and returns its end. Fails as
  /// WorldAt::open(), and (bad_request) if more than kEditsMax edits lie between the moment and the
  /// stored moment before it.
  StoreResult<LogEnd> open(Sequence at);
  /// Opens the moment after the last edit at or before this time (UTC).
  StoreResult<LogEnd> open_at_time(TimeUs utc_us);
  /// Makes the calls under way that open a moment, and all later calls, fail soon (cancelled).
  /// Thread: any.
  void cancel() { is_cancelled_.store(true); }
  /// Returns the chunk as it was after edit `at`. Opens the moment again if it is no longer kept.
  StoreResult<Chunk> chunk(Sequence at, const ChunkKey& key);

 private:
  struct Kept {
    std::mutex mutex;  // guards the world and its reader
    std::unique_ptr<WorldReader> reader;
    std::unique_ptr<WorldAt> world;  // null until it is open
  };
  /// Returns the moment. Opens it if it is not open.
  StoreResult<std::shared_ptr<Kept>> find(Sequence at);
  void forget(Sequence at);
  StoreResult<Chunk> made_chunk(Sequence at, const ChunkKey& key);

  const std::string place_;
  const Generator& generator_;
  const std::size_t kept_max_;
  std::atomic<bool> is_cancelled_{false};
  std::mutex mutex_;                                            // guards the list alone
  std::list<std::pair<Sequence, std::shared_ptr<Kept>>> kept_;  // used last first
};

}  // namespace runstone
