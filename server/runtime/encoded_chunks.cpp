#include "server/runtime/encoded_chunks.hpp"

#include <utility>

namespace runstone {

EncodedMessage EncodedChunks::snapshot(const ChunkKey& key, const ChunkPtr& chunk,
                                       ChunkEncoding encoding) {
  const Name name{key, chunk.get(), encoding};
  std::promise<EncodedMessage> promise;
  std::shared_future<EncodedMessage> known;
  {
    const std::lock_guard lock(mutex_);
    auto found = entries_.find(name);
    if (found != entries_.end() && found->second.chunk.lock() != chunk) {
      drop(found);
      found = entries_.end();
    }
    if (found != entries_.end()) {
      turns_.splice(turns_.begin(), turns_, found->second.turn);
      known = found->second.message;
    } else {
      turns_.push_front(name);
      entries_.emplace(name, Entry{chunk, promise.get_future().share(), 0, turns_.begin()});
      ++encoded_;
    }
  }
  if (known.valid()) return known.get();

  EncodedMessage message = encode_snapshot(key, *chunk, encoding);
  promise.set_value(message);
  const std::lock_guard lock(mutex_);
  const auto mine = entries_.find(name);
  if (mine == entries_.end() || mine->second.bytes != 0)
    return message;  // dropped, perhaps made anew
  mine->second.bytes = message.bytes->size();
  bytes_ += mine->second.bytes;
  while (bytes_ > bytes_max_) drop(entries_.find(turns_.back()));
  return message;
}

void EncodedChunks::drop(Entries::iterator entry) {
  bytes_ -= entry->second.bytes;
  turns_.erase(entry->second.turn);
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
