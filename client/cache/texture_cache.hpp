// TextureCache: pictures of textures that a client keeps on disk between its runs, by their hash.
// The cache is shared by all servers. A row may be damaged: the reader checks the hash
// (TextureExchange). A database that cannot be read is replaced by a new one. Beyond `bytes_max`
// the pictures that were unused for longest are evicted. Calls wait for the disk.
// Thread: one at a time.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "client/cache/cache_database.hpp"
#include "common/core/texture.hpp"
#include "protocol/codec/texture_messages.hpp"

namespace runstone {

class TextureCache {
 public:
  /// The default of `bytes_max`: four times the most that a world has.
  static constexpr std::uint64_t kBytesMax = 4 * kTexturesBytesMax;

  /// Opens the database in the folder of a ChunkCache, which must be open: its lock keeps other
  /// processes away.
  explicit TextureCache(const std::string& folder, std::uint64_t bytes_max = kBytesMax);
  ~TextureCache();

  /// Returns the pictures with these hashes that are in the cache.
  std::vector<TexturePart> find(std::span<const TextureHash> hashes);
  /// Writes pictures in one transaction.
  void keep(std::span<const TexturePart> parts);
  /// Returns the bytes of all pictures, with those of their rows.
  std::uint64_t bytes() const { return bytes_; }
  /// Returns the newest warning since the last call, one line, or an empty text. After a failure
  /// that a new database does not mend, the cache finds and keeps nothing any more.
  std::string take_warning();

 private:
  struct Tables;
  void open();
  /// Replaces a damaged database, and ends the cache after any other failure.
  void handle_failure();
  void evict();

  const std::string file_;
  const std::uint64_t bytes_max_;
  std::unique_ptr<CacheDatabase> database_;  // declared before the statements, which use it
  std::unique_ptr<Tables> tables_;
  std::uint64_t bytes_ = 0;  // of all pictures
  std::int64_t stamp_ = 0;   // of rows that are used now; lower ones were used longer ago
  bool has_ended_ = false;
  std::string warning_;
};

}  // namespace runstone
