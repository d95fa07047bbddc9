// ChunkCache: chunks and tiles that a client keeps on disk between its runs. A row has world, key,
// version, digest and packed bytes. The cache returns a chunk exactly as it was stored, or not at
// all:
//   - every row has a checksum over its other columns, and the digest of its voxels must match; a
//     row that fails a check is dropped and counted;
//   - a database that is damaged as a whole is renamed to "cache.sqlite.damaged", and a new one is
//     begun;
//   - the write-ahead log of SQLite survives a kill at any moment; after a power failure the newest
//     batches may be missing (synchronous NORMAL);
//   - if the server of a world lost edits or was restored from a backup, chunks outside the common
//     history are dropped (SharedHistory);
//   - if the server of a world makes tiles by other rules, the tiles are dropped.
// The size is bounded: beyond `bytes_max` the chunks and tiles that were unused for longest are
// evicted. Tiles need no other rule: those of a view take a few per cent of the bytes of its
// chunks, and a client that comes back needs both. One process at a time uses the folder. Calls
// wait for the disk.
// Thread: one at a time.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client/cache/cache_counters.hpp"
#include "client/cache/cache_database.hpp"
#include "client/replica/cache_lookup.hpp"
#include "common/core/result.hpp"
#include "common/os/file_lock.hpp"

namespace runstone {

/// Returns $XDG_CACHE_HOME/runstone, otherwise $HOME/.cache/runstone, or an empty text if neither
/// variable is an absolute path.
std::string default_cache_folder();

class ChunkCache {
 public:
  /// Opens the cache and makes the folder if needed. Fails with one line of text that names the
  /// folder if it cannot be written or another process uses it. `bytes_max` counts rows with their
  /// share of the indexes; the file may be half as large again.
  static Result<std::unique_ptr<ChunkCache>, std::string> open(const std::string& folder,
                                                               std::uint64_t bytes_max);

  /// Returns the chunks of the lookup that are in the cache, in the order of its keys. Stops when
  /// they take `bytes_max`; one chunk may exceed it.
  std::vector<KeyedChunk> find(const CacheLookup& lookup);
  /// Writes chunks and the state of their world in one transaction.
  void keep(const CachedWorld& world, std::span<const KeyedChunk> chunks);

  ~ChunkCache();

  const CacheCounters& counters() const { return counters_; }
  std::uint64_t bytes() const { return bytes_; }
  /// Returns the newest warning since the last call, one line, or an empty text. After a failure
  /// other than damage, such as a full disk, the cache finds and keeps nothing any more.
  std::string take_warning();

 private:
  struct Tables;
  ChunkCache(std::string file, std::uint64_t bytes_max, FileLock lock);
  void open_database();
  /// Returns the row id of the world. Adds the world if needed, and drops its chunks outside the
  /// common history.
  std::int64_t enter(const CachedWorld& world);
  /// Drops the chunks unused for longest until the size is within the bound.
  void evict();
  /// Renames the damaged database.
  void set_aside();
  /// Handles a failure of the last batch: renames a damaged database, and ends the cache after any
  /// other failure.
  void handle_failure();
  std::optional<KeyedChunk> read(const CachedWorld& world, std::int64_t row, const ChunkKey& key);

  const std::string file_;
  const std::uint64_t bytes_max_;
  FileLock lock_;
  std::unique_ptr<CacheDatabase> database_;  // declared before the statements, which use it
  std::unique_ptr<Tables> tables_;
  std::uint64_t bytes_ = 0;  // of all rows
  std::int64_t stamp_ = 0;  // of rows that are used or written now; lower ones were used longer ago
  bool has_ended_ = false;
  CacheCounters counters_;
  std::string warning_;
};

}  // namespace runstone
