// CacheThread: runs the chunk cache on its own thread, so that a session never waits for the disk.
// Lookups are handled before chunks to keep. Each lookup has one result, in order.
// Threads: the owner makes all calls. `wake` is called from the cache thread.
#pragma once
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "client/cache/chunk_cache.hpp"

namespace runstone {

class CacheThread {
 public:
  /// The greatest number of chunks that wait to be written, and about their greatest memory.
  /// Further ones stay with the replica.
  static constexpr std::size_t kKeepMax = 4'096;
  static constexpr std::size_t kKeepBytesMax = std::size_t{64} << 20;

  /// `wake` is called after each result.
  CacheThread(std::unique_ptr<ChunkCache> cache, std::function<void()> wake);
  /// Calls stop().
  ~CacheThread();

  void look_up(CacheLookup lookup);
  /// Returns the number of chunks that keep() should get now.
  std::size_t room() const;
  void keep(const CachedWorld& world, std::vector<KeyedChunk> chunks);
  /// Returns the results of lookups since the last call, in order: the chunks that were found.
  std::vector<std::vector<KeyedChunk>> drain_results();
  /// Writes the waiting chunks and ends the thread. Later lookups and chunks are ignored.
  void stop();

  CacheCounters counters() const;
  /// Returns the newest warning since the last call, one line, or an empty text.
  std::string take_warning();

 private:
  struct Batch {
    CachedWorld world;
    std::vector<KeyedChunk> chunks;
    std::size_t bytes = 0;
  };
  void run();

  std::unique_ptr<ChunkCache> cache_;  // used by the thread only
  const std::function<void()> wake_;
  // It guards all members below except thread_. No other lock is taken while it is locked.
  mutable std::mutex mutex_;
  std::condition_variable has_work_;
  std::deque<CacheLookup> lookups_;
  std::deque<Batch> batches_;
  // In batches_ and in the one being written.
  std::size_t waiting_ = 0, waiting_bytes_ = 0;
  std::vector<std::vector<KeyedChunk>> results_;
  CacheCounters counters_;
  std::string warning_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace runstone
