// ChunkCache: chunks that a client keeps on disk between its runs, by world and key: version, digest, packed bytes. What
// comes out of it is what went in, or nothing:
//   - every row has a checksum over all of it, and its voxels must give the digest; a row that does not hold is dropped
//     and counted;
//   - a database that is damaged as a whole is set aside ("cache.sqlite.damaged") and begun anew;
//   - SQLite's WAL survives the end of the process at any moment (synchronous NORMAL: the end of power as well, but for
//     the newest batches);
//   - of a world whose server lost edits or stands on a backup, what is not common history goes (SharedHistory).
// Bounded: beyond `bytes_max` the chunks that were longest unused go. One process at a time has the folder. Blocks on the
// disk; one thread at a time.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client/cache/cache_database.hpp"
#include "client/replica/cache_lookup.hpp"
#include "common/core/result.hpp"
#include "common/os/file_lock.hpp"

namespace runstone {

struct CacheCounters {
  std::uint64_t hits = 0, misses = 0;
  std::uint64_t corrupt = 0;     // rows that did not hold
  std::uint64_t kept = 0;        // chunks written
  std::uint64_t evicted = 0;     // to keep the bound
  std::uint64_t not_common = 0;  // edited by a server that is gone
  std::uint64_t databases_set_aside = 0;
};

/// $XDG_CACHE_HOME/runstone, else $HOME/.cache/runstone; empty if neither variable names a folder.
std::string default_cache_folder();

class ChunkCache {
 public:
  /// Makes the folder if needed. The error is one line that names the folder: it cannot be written, or another process
  /// has it. `bytes_max` counts rows with what they need around them; the file may be half as large again.
  static Result<std::unique_ptr<ChunkCache>, std::string> open(const std::string& folder,
                                                               std::uint64_t bytes_max);

  /// Those of the chunks that are here, in the order asked.
  std::vector<KeyedChunk> find(const CachedWorld& world, std::span<const ChunkKey> keys);
  /// Writes chunks, and what is known of their world now, in one transaction.
  void keep(const CachedWorld& world, std::span<const KeyedChunk> chunks);

  ~ChunkCache();

  const CacheCounters& counters() const { return counters_; }
  std::uint64_t bytes() const { return bytes_; }
  /// What went wrong since the last call, for the log: one line, or empty. After a failure other than damage (a full disk)
  /// the cache finds and keeps nothing any more.
  std::string take_warning();

 private:
  struct Tables;
  ChunkCache(std::string file, std::uint64_t bytes_max, FileLock lock);
  void open_database();
  /// Of this world, with only common history left in it.
  std::int64_t enter(const CachedWorld& world);
  void evict();
  void set_aside();
  /// After a batch: damage sets the database aside, anything else ends the cache.
  void settle();
  std::optional<KeyedChunk> read(const CachedWorld& world, std::int64_t row, const ChunkKey& key);

  const std::string file_;
  const std::uint64_t bytes_max_;
  FileLock lock_;
  std::unique_ptr<CacheDatabase> database_;  // before the statements
  std::unique_ptr<Tables> tables_;
  std::uint64_t bytes_ = 0;  // of all rows
  std::int64_t stamp_ = 0;   // of this run: rows with a lower one were not used in it
  bool has_ended_ = false;
  CacheCounters counters_;
  std::string warning_;
};

}  // namespace runstone
