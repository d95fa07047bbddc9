#include "client/replica/cache_outbox.hpp"

#include <algorithm>

namespace runstone {

void CacheOutbox::add(const TrackedChunk& chunk) {
  if (!is_enabled_ || !chunk.is_for_cache() || left_.size() >= kCacheOutboxMax) return;
  left_.emplace_back(chunk.key, chunk.confirmed());
}

std::vector<KeyedChunk> CacheOutbox::take(ReplicaChunks* chunks, std::size_t count_max) {
  const std::size_t count = std::min(count_max, left_.size());
  const auto end = left_.begin() + static_cast<std::ptrdiff_t>(count);
  std::vector<KeyedChunk> out(left_.begin(), end);
  left_.erase(left_.begin(), end);
  if (chunks == nullptr) return out;
  for (auto& [key, chunk] : *chunks) {
    if (out.size() >= count_max) break;
    if (!chunk.is_for_cache()) continue;
    chunk.cached = chunk.confirmed()->version;
    out.emplace_back(key, chunk.confirmed());
  }
  return out;
}

}  // namespace runstone
