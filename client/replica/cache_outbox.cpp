#include "client/replica/cache_outbox.hpp"

#include <algorithm>

namespace runstone {
namespace {

std::size_t outbox_bytes_of(const Chunk& chunk) {
  return sizeof(Chunk) + chunk.voxels.runs.byte_capacity();
}

}  // namespace

void CacheOutbox::add(const TrackedChunk& chunk) {
  if (!is_enabled_ || !chunk.is_for_cache() || left_.size() >= kCacheOutboxMax) return;
  const std::size_t bytes = outbox_bytes_of(*chunk.confirmed());
  if (bytes_ + bytes > kCacheOutboxBytesMax) return;
  bytes_ += bytes;
  left_.emplace_back(chunk.key, chunk.confirmed());
}

std::vector<KeyedChunk> CacheOutbox::take(ReplicaChunks* chunks, std::size_t count_max) {
  if (chunks == nullptr) next_.reset();
  const bool is_continued = next_.has_value();
  std::vector<KeyedChunk> out = take_left(count_max);
  if (chunks == nullptr) return out;
  take_changed(*chunks, count_max, out);
  if (is_continued && out.empty()) take_changed(*chunks, count_max, out);
  return out;
}

std::vector<KeyedChunk> CacheOutbox::take_left(std::size_t count_max) {
  const std::size_t count = std::min(count_max, left_.size());
  const auto end = left_.begin() + static_cast<std::ptrdiff_t>(count);
  std::vector<KeyedChunk> out(left_.begin(), end);
  left_.erase(left_.begin(), end);
  for (const auto& [key, chunk] : out) bytes_ -= outbox_bytes_of(*chunk);
  return out;
}

void CacheOutbox::take_changed(ReplicaChunks& chunks, std::size_t count_max,
                               std::vector<KeyedChunk>& out) {
  std::size_t bytes = 0;
  auto at = next_ ? chunks.lower_bound(*next_) : chunks.begin();
  next_.reset();
  for (; at != chunks.end(); ++at) {
    auto& [key, chunk] = *at;
    if (!chunk.is_for_cache()) continue;
    if (out.size() >= count_max || bytes >= kCacheBatchBytesMax) {
      next_ = key;
      return;
    }
    bytes += outbox_bytes_of(*chunk.confirmed());
    chunk.cached = chunk.confirmed()->version;
    out.emplace_back(key, chunk.confirmed());
  }
}

}  // namespace runstone
