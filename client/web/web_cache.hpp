// WebCache: the chunk cache of the browser client. The page keeps the rows in IndexedDB
// (page/chunks.js); this object makes and checks them. It has the same rules as ChunkCache
// (client/cache), but no chunks of its own: a row that was found goes to the session, one at a
// time, and a chunk to keep becomes bytes.
//   - Each lookup has one result, in order. Rows that fail a check are dropped.
//   - If IndexedDB fails, for example because the browser has no more room, the cache ends: it
//     finds and keeps nothing any more.
// Bound: kBatchesMax batches of rows wait to be written. Further chunks stay with the replica.
// Thread: the page's only one. Calls return at once; the page calls found(), looked_up() and kept()
// later.
#pragma once
#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "client/cache/cache_counters.hpp"
#include "client/replica/cache_lookup.hpp"
#include "common/core/bytes.hpp"

namespace runstone {

class WebCache {
 public:
  /// The number of chunks of one batch, and of batches that may wait.
  static constexpr std::size_t kBatchChunksMax = 64, kBatchesMax = 2;

  /// `worlds`: the worlds of which the page has rows, as they were described last.
  explicit WebCache(const std::vector<CachedWorld>& worlds);

  void look_up(CacheLookup lookup);
  /// Returns the results of lookups since the last call, in order: the chunks that were found.
  std::vector<std::vector<KeyedChunk>> drain_results();
  /// Returns the number of chunks that keep() should get now.
  std::size_t room() const;
  /// Makes rows of chunks. They are written when they are kBatchChunksMax, or by flush().
  void keep(const CachedWorld& world, const std::vector<KeyedChunk>& chunks);
  /// Writes the rows that were made.
  void flush();
  void discard_batch();
  const CacheCounters& counters() const { return counters_; }

  // Calls of the page.
  /// Takes the row of a key of the oldest lookup. `index`: the place of the key in the lookup.
  /// Returns false if the memory of the lookup is used up: the page then reads no more rows for it.
  bool found(std::size_t index, ByteView record);
  /// Ends the oldest lookup.
  void looked_up();
  /// Ends the oldest batch: it was written, and `evicted` rows were dropped for the size bound.
  void kept(std::size_t rows, std::size_t evicted);
  /// Counts rows that the page has dropped because they are outside of the common history.
  void dropped(std::size_t rows) { counters_.not_common += rows; }
  /// Ends the cache.
  void fail();

 private:
  struct OpenLookup {
    CacheLookup lookup;
    std::vector<KeyedChunk> found;
    std::size_t bytes = 0;  // of found, in memory
  };
  /// Gives the page the new description of the world, and orders it to drop rows that are outside
  /// of the common history.
  void enter(const CachedWorld& world);

  std::map<WorldId, CachedWorld> worlds_;
  std::deque<OpenLookup> lookups_;
  std::vector<std::vector<KeyedChunk>> results_;
  WorldId batch_world_{};
  Bytes batch_;  // rows that were made, as page_cache_keep() takes them
  std::size_t batch_chunks_ = 0;
  std::size_t batches_waiting_ = 0;  // with the page
  bool has_ended_ = false;
  CacheCounters counters_;
};

/// Reads worlds from lines "WORLD EDGE EPOCH DURABLE HEAD RULES", the first in hex. Lines of
/// another form are left out.
std::vector<CachedWorld> read_cached_worlds(const std::string& text);

}  // namespace runstone
