// EncodedChunks: a cache of encoded snapshots. Players in one place need the same chunks at the
// same versions, so each is encoded once in each encoding, and every session queues the same entry.
// The least recently used are evicted.
// Threads: any.
#pragma once
#include <cstddef>
#include <cstdint>
#include <future>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

#include "common/runs/chunk.hpp"
#include "protocol/codec/chunk_entries.hpp"

namespace runstone {

class EncodedChunks {
 public:
  static constexpr std::size_t kBytesMax = 1 << 20;  // about 1,000 packed chunks

  explicit EncodedChunks(std::size_t bytes_max = kBytesMax) : bytes_max_(bytes_max) {}

  /// Returns the chunk's snapshot. Encodes it, unless it is cached. Waits if another thread encodes
  /// it.
  ChunkEntry snapshot(const ChunkKey& key, const ChunkPtr& chunk, ChunkEncoding encoding);

  /// Returns how many snapshots were encoded.
  std::uint64_t encoded() const;
  /// Returns the bytes of the cached snapshots.
  std::size_t bytes() const;

 private:
  using EntryKey = std::tuple<ChunkKey, const Chunk*, ChunkEncoding>;
  struct Entry {
    std::weak_ptr<const Chunk> chunk;  // detects an address that was used again
    std::shared_future<ChunkEntry> snapshot;
    std::size_t bytes = 0;  // 0 until the snapshot is encoded
    std::list<EntryKey>::iterator place;
  };
  using Entries = std::map<EntryKey, Entry>;
  void drop(Entries::iterator entry);

  const std::size_t bytes_max_;
  mutable std::mutex mutex_;  // a leaf: guards the rest
  Entries entries_;
  std::list<EntryKey> by_use_;  // the most recently used first
  std::size_t bytes_ = 0;
  std::uint64_t encoded_ = 0;
};

}  // namespace runstone
