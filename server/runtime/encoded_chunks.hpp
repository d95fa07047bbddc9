// EncodedChunks: snapshots that were encoded a moment ago. A crowd in one place wants the same chunks at the same
// versions: each is encoded once in each encoding, and every session queues the same bytes. Those used last are kept.
// Any thread.
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
#include "protocol/codec/messages.hpp"

namespace runstone {

class EncodedChunks {
 public:
  static constexpr std::size_t kBytesMax = 1 << 20;  // some 1,000 packed chunks

  explicit EncodedChunks(std::size_t bytes_max = kBytesMax) : bytes_max_(bytes_max) {}

  /// The chunk's snapshot message. Encodes it, unless that was done or another thread is at it, which is then waited for.
  EncodedMessage snapshot(const ChunkKey& key, const ChunkPtr& chunk, ChunkEncoding encoding);

  /// How many were encoded.
  std::uint64_t encoded() const;
  /// Bytes of messages kept.
  std::size_t bytes() const;

 private:
  using Name = std::tuple<ChunkKey, const Chunk*, ChunkEncoding>;
  struct Entry {
    std::weak_ptr<const Chunk> chunk;  // an address alone may come to name another one
    std::shared_future<EncodedMessage> message;
    std::size_t bytes = 0;  // 0 until it is encoded
    std::list<Name>::iterator turn;
  };
  using Entries = std::map<Name, Entry>;
  void drop(Entries::iterator entry);

  const std::size_t bytes_max_;
  mutable std::mutex mutex_;  // a leaf: guards the rest
  Entries entries_;
  std::list<Name> turns_;  // used last first
  std::size_t bytes_ = 0;
  std::uint64_t encoded_ = 0;
};

}  // namespace runstone
