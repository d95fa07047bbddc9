#include "server/runtime/encoded_chunks.hpp"

#include <utility>

namespace runstone {

ChunkEntry EncodedChunks::snapshot(const ChunkKey& key, const ChunkPtr& chunk,
                                   ChunkEncoding encoding) {
  const EntryKey id{key, chunk.get(), encoding};
  std::promise<ChunkEntry> promise;
  std::shared_future<ChunkEntry> known;
  {
    const std::lock_guard lock(mutex_);
    auto found = entries_.find(id);
    if (found != entries_.end() && found->second.chunk.lock() != chunk) {
      drop(found);
      found = entries_.end();
    }
    if (found != entries_.end()) {
      by_use_.splice(by_use_.begin(), by_use_, found->second.place);
      known = found->second.snapshot;
    } else {
      by_use_.push_front(id);
      entries_.emplace(id, Entry{chunk, promise.get_future().share(), 0, by_use_.begin()});
      ++encoded_;
    }
  }
  if (known.valid()) return known.get();

  ChunkEntry snapshot = encode_snapshot(key, *chunk, encoding);
  promise.set_value(snapshot);
  const std::lock_guard lock(mutex_);
  const auto entry = entries_.find(id);
  if (entry == entries_.end() || entry->second.bytes != 0)
    return snapshot;  // evicted meanwhile, perhaps encoded again
  entry->second.bytes = snapshot.bytes->size();
  bytes_ += entry->second.bytes;
  while (bytes_ > bytes_max_) drop(entries_.find(by_use_.back()));
  return snapshot;
}

void EncodedChunks::drop(Entries::iterator entry) {
  bytes_ -= entry->second.bytes;
  by_use_.erase(entry->second.place);
  entries_.erase(entry);
}

std::uint64_t EncodedChunks::encoded() const {
  const std::lock_guard lock(mutex_);
  return encoded_;
}

std::size_t EncodedChunks::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace runstone
