// CacheThread: the chunk cache on a thread of its own, so that no disk holds up a session. Questions come before chunks to
// be kept; each is answered once, in order. Threads: all calls from the one that owns it; `wake` comes from the cache's.
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
  static constexpr std::size_t kKeepMax =
      4'096;  // chunks that wait to be written; more stay with the replica

  /// `wake` is called when there is an answer.
  CacheThread(std::unique_ptr<ChunkCache> cache, std::function<void()> wake);
  /// As stop().
  ~CacheThread();

  void ask(CacheLookup question);
  /// How many chunks keep() takes now.
  std::size_t room() const;
  void keep(const CachedWorld& world, std::vector<KeyedChunk> chunks);
  /// What was found, one entry for each question, in order.
  std::vector<std::vector<KeyedChunk>> take_answers();
  /// Writes what waits, then ends the thread. Nothing is taken afterwards.
  void stop();

  CacheCounters counters() const;
  /// One line that went wrong since the last call, or empty.
  std::string take_warning();

 private:
  struct Batch {
    CachedWorld world;
    std::vector<KeyedChunk> chunks;
  };
  void run();

  std::unique_ptr<ChunkCache> cache_;  // of the thread
  const std::function<void()> wake_;
  mutable std::mutex mutex_;  // a leaf: guards all that follows, but for the thread
  std::condition_variable has_work_;
  std::deque<CacheLookup> questions_;
  std::deque<Batch> batches_;
  std::size_t waiting_ = 0;  // chunks in batches_ and in the one being written
  std::vector<std::vector<KeyedChunk>> answers_;
  CacheCounters counters_;
  std::string warning_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace runstone
