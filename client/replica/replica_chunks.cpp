#include "client/replica/replica_chunks.hpp"

namespace runstone {

TrackedChunk* ReplicaChunks::find(const ChunkKey& key) {
  const auto it = chunks_.find(key);
  return it == chunks_.end() ? nullptr : &it->second;
}

const TrackedChunk* ReplicaChunks::find(const ChunkKey& key) const {
  const auto it = chunks_.find(key);
  return it == chunks_.end() ? nullptr : &it->second;
}

std::pair<TrackedChunk*, bool> ReplicaChunks::track(const ChunkKey& key) {
  const auto [it, is_new] = chunks_.try_emplace(key, key);
  if (is_new) {
    ++counts_[static_cast<std::size_t>(ChunkState::expected)];
    recount(it->second);
  }
  return {&it->second, is_new};
}

void ReplicaChunks::clear() {
  chunks_.clear();
  counts_.fill(0);
  confirmed_count_ = 0;
  bytes_ = 0;
  awaiting_.clear();
}

void ReplicaChunks::set_current(TrackedChunk& chunk, ChunkPtr confirmed) {
  set_confirmed(chunk, std::move(confirmed));
  set_state(chunk, ChunkState::current);
}

void ReplicaChunks::set_unavailable(TrackedChunk& chunk) {
  chunk.inbox.clear();
  chunk.repeatable.clear();
  set_confirmed(chunk, nullptr);
  set_state(chunk, ChunkState::unavailable);
}

void ReplicaChunks::set_confirmed(TrackedChunk& chunk, ChunkPtr confirmed) {
  if (chunk.confirmed_) --confirmed_count_;
  if (confirmed) ++confirmed_count_;
  chunk.confirmed_ = std::move(confirmed);
  recount(chunk);
}

void ReplicaChunks::recount(TrackedChunk& chunk) {
  bytes_ -= chunk.counted_bytes_;
  chunk.counted_bytes_ = chunk.bytes();
  bytes_ += chunk.counted_bytes_;
}

void ReplicaChunks::set_state(TrackedChunk& chunk, ChunkState state) {
  --counts_[static_cast<std::size_t>(chunk.state_)];
  ++counts_[static_cast<std::size_t>(state)];
  if (is_awaiting(chunk.state_) != is_awaiting(state)) {
    if (is_awaiting(state)) {
      awaiting_.insert(chunk.key);
    } else {
      awaiting_.erase(chunk.key);
    }
  }
  chunk.state_ = state;
}

ReplicaChunks::Map::iterator ReplicaChunks::erase(Map::iterator it) {
  set_state(it->second, ChunkState::expected);
  --counts_[static_cast<std::size_t>(ChunkState::expected)];
  set_confirmed(it->second, nullptr);
  bytes_ -= it->second.counted_bytes_;
  return chunks_.erase(it);
}

}  // namespace runstone
