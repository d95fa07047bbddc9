#include "server/interest/session_interest.hpp"

#include <algorithm>
#include <functional>

#include "common/core/assert.hpp"

namespace runstone {

SessionInterest::Moved SessionInterest::set_view(const View& view) {
  Moved moved;
  if (view_ == view) return moved;
  moved.steps = queue_.size();
  std::vector<ChunkCoord> chunks = wanted();
  if (view_ && view_->same_chunks(view)) {
    set_queue(view, chunks);
    return moved;
  }
  std::vector<ChunkCoord> left;
  if (view_) append_difference(*view_, view, limit_, left);
  for (const ChunkCoord at : left) {
    const auto found = chunks_.find({0, at});
    if (found == chunks_.end()) continue;
    moved.left.push_back({found->first, found->second});
    --counter(found->second);
    chunks_.erase(found);
  }
  std::erase_if(chunks, [&](ChunkCoord at) { return !view.contains(at); });
  const std::size_t kept = chunks.size();
  append_difference(view, view_, limit_, chunks);
  moved.steps += left.size() + chunks.size() - kept;
  set_queue(view, chunks);
  return moved;
}

std::vector<ChunkCoord> SessionInterest::wanted() const {
  std::vector<ChunkCoord> chunks;
  chunks.reserve(queue_.size());
  for (const ViewOrder::Place place : queue_) {
    const ChunkCoord at = order_->chunk_at(place);
    if (is_wanted(at)) chunks.push_back(at);
  }
  return chunks;
}

void SessionInterest::set_queue(const View& view, const std::vector<ChunkCoord>& chunks) {
  view_ = view;
  order_.emplace(view);
  queue_.clear();
  queue_.reserve(chunks.size());
  for (const ChunkCoord at : chunks) queue_.push_back(order_->place_of(at));
  std::make_heap(queue_.begin(), queue_.end(), std::greater<>());
}

void SessionInterest::pop_nearest() {
  std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
  queue_.pop_back();
}

std::optional<ChunkKey> SessionInterest::nearest_wanted() {
  while (!queue_.empty()) {
    const ChunkCoord at = order_->chunk_at(queue_.front());
    if (is_wanted(at)) return ChunkKey{0, at};
    pop_nearest();
  }
  return std::nullopt;
}

std::optional<ChunkInterest> SessionInterest::state(const ChunkKey& key) const {
  const auto found = chunks_.find(key);
  if (found != chunks_.end()) return found->second;
  if (key.lod != 0 || !view_ || !view_->contains(key.at) || !limit_.contains(key.at))
    return std::nullopt;
  return ChunkInterest::wanted;
}

void SessionInterest::set_state(const ChunkKey& key, ChunkInterest state) {
  const auto was = this->state(key);
  RUNSTONE_ASSERT(was.has_value());
  if (*was == state) return;
  if (*was != ChunkInterest::wanted) --counter(*was);
  if (state != ChunkInterest::wanted) {
    ++counter(state);
    chunks_.insert_or_assign(key, state);
    // A chunk was first in the queue when it was sent. Removing it keeps a chunk that is wanted
    // again and again in the queue once.
    if (!queue_.empty() && order_->chunk_at(queue_.front()) == key.at) pop_nearest();
    return;
  }
  chunks_.erase(key);
  queue_.push_back(order_->place_of(key.at));
  std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
}

std::optional<ChunkKey> SessionInterest::next_for_digest_check() {
  if (count(ChunkInterest::subscribed) == 0) return std::nullopt;
  auto at = digest_checked_ ? chunks_.upper_bound(*digest_checked_) : chunks_.begin();
  // The loop makes at most one round, because there is a subscribed chunk.
  for (std::size_t step = 0; step <= chunks_.size(); ++step) {
    if (at == chunks_.end()) at = chunks_.begin();
    if (at->second == ChunkInterest::subscribed) {
      digest_checked_ = at->first;
      return at->first;
    }
    ++at;
  }
  return std::nullopt;
}

}  // namespace runstone
