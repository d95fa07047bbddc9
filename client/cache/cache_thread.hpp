// CacheThread: runs the chunk cache and the texture cache on their own thread, so that a session
// never waits for the disk. Lookups are handled before what is to be kept, and those of chunks
// first. Each lookup has one result, in order.
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
#include "client/cache/texture_cache.hpp"

namespace runstone {

class CacheThread {
 public:
  /// The greatest number of chunks that wait to be written, and about their greatest memory.
  /// Further ones stay with the replica.
  static constexpr std::size_t kKeepMax = 4'096;
  static constexpr std::size_t kKeepBytesMax = std::size_t{64} << 20;

  /// `wake` is called after each result. `textures` may be null: then no pictures are found and
  /// kept.
  CacheThread(std::unique_ptr<ChunkCache> cache, std::unique_ptr<TextureCache> textures,
              std::function<void()> wake);
  /// Calls stop().
  ~CacheThread();

  void look_up(CacheLookup lookup);
  /// Returns the number of chunks that keep() should get now.
  std::size_t room() const;
  void keep(const CachedWorld& world, std::vector<KeyedChunk> chunks);
  /// Returns the results of lookups since the last call, in order: the chunks that were found.
  std::vector<std::vector<KeyedChunk>> drain_results();
  void look_up_textures(std::vector<TextureHash> hashes);
  /// Queues pictures to be stored. TextureTable bounds their number and bytes.
  void keep_textures(std::vector<TexturePart> parts);
  /// Returns the results of lookups of textures since the last call, in order: the pictures that
  /// were found.
  std::vector<std::vector<TexturePart>> drain_textures();
  /// Writes the waiting chunks and pictures and ends the thread. Later lookups, chunks and pictures
  /// are ignored.
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

  std::unique_ptr<ChunkCache> cache_;       // used by the thread only
  std::unique_ptr<TextureCache> textures_;  // used by the thread only; may be null
  const std::function<void()> wake_;
  // It guards all members below except thread_. No other lock is taken while it is locked.
  mutable std::mutex mutex_;
  std::condition_variable has_work_;
  std::deque<CacheLookup> lookups_;
  std::deque<Batch> batches_;
  // In batches_ and in the one being written.
  std::size_t waiting_ = 0, waiting_bytes_ = 0;
  std::vector<std::vector<KeyedChunk>> results_;
  std::deque<std::vector<TextureHash>> texture_lookups_;
  std::vector<TexturePart> texture_parts_;  // to keep
  std::vector<std::vector<TexturePart>> texture_results_;
  CacheCounters counters_;
  std::string warning_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace runstone
