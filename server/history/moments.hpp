// Moments: the worlds of the past that somebody looks at, ready to make chunks. Each has a reader of its own; a few are
// kept, the ones used last, since those who scrub come back. Any thread; a moment makes one chunk at a time. Blocks on
// the disk.
#pragma once
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "server/history/world_at.hpp"

namespace runstone {

class Moments {
 public:
  /// Edits that opening a moment may have to read and keep; with keyframes there are some 32,768.
  static constexpr Sequence kEditsMax = 1'000'000;

  /// `generator` must outlive the object. Keeps `kept_max` moments, at least 1.
  Moments(std::string folder, const Generator& generator, std::size_t kept_max = 4)
      : folder_(std::move(folder)), generator_(generator), kept_max_(kept_max) {}

  /// The moment after the edit with this sequence. Fails as WorldAt::open() does, and
  /// (bad_request) if more than kEditsMax edits lie between it and the stored moment before.
  StoreResult<LogEnd> open(Sequence at);
  /// The moment after the last edit at or before this time (UTC).
  StoreResult<LogEnd> open_at_time(TimeUs utc_us);
  /// The chunk as it stood after edit `at`; the moment is opened anew if it is no longer kept.
  StoreResult<Chunk> chunk(Sequence at, const ChunkKey& key);

 private:
  struct Kept {
    std::mutex mutex;  // guards the world and its reader
    std::unique_ptr<WorldReader> reader;
    std::unique_ptr<WorldAt> world;  // null until it is open
    LogEnd end;
  };
  /// Opened, if it has not been.
  StoreResult<std::shared_ptr<Kept>> find(Sequence at);
  void forget(Sequence at);

  const std::string folder_;
  const Generator& generator_;
  const std::size_t kept_max_;
  std::mutex mutex_;                                            // guards the list alone
  std::list<std::pair<Sequence, std::shared_ptr<Kept>>> kept_;  // used last first
};

}  // namespace runstone
