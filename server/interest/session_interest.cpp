#include "server/interest/session_interest.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {

namespace {

// Returns a comparison for heaps, which have their largest element on top.
auto later(const ViewOrder& order) {
  return [&order](const ChunkKey& a, const ChunkKey& b) { return order(b, a); };
}

}  // namespace

SessionInterest::Moved SessionInterest::set_view(const View& view) {
  Moved moved;
  if (view_ == view) return moved;
  if (view_ && view_->same_chunks(view)) {
    std::erase_if(queue_, [&](const ChunkKey& key) { return !is_wanted(key); });
    moved.steps = queue_.size();
    set_order(view);
    return moved;
  }
  std::vector<ChunkCoord> cells;
  if (view_) append_difference(*view_, view, limit_, cells);
  for (const ChunkCoord at : cells) {
    const auto found = chunks_.find({0, at});
    if (found == chunks_.end()) continue;
    moved.left.push_back({found->first, found->second});
    --counter(found->second);
    chunks_.erase(found);
  }
  moved.steps = cells.size() + queue_.size();
  std::erase_if(queue_,
                [&](const ChunkKey& key) { return !view.contains(key.at) || !is_wanted(key); });
  cells.clear();
  append_difference(view, view_, limit_, cells);
  for (const ChunkCoord at : cells) queue_.push_back({0, at});
  moved.steps += cells.size();
  set_order(view);
  return moved;
}

void SessionInterest::set_order(const View& view) {
  view_ = view;
  order_.emplace(view);
  std::make_heap(queue_.begin(), queue_.end(), later(*order_));
}

void SessionInterest::pop_nearest() {
  std::pop_heap(queue_.begin(), queue_.end(), later(*order_));
  queue_.pop_back();
}

std::optional<ChunkKey> SessionInterest::nearest_wanted() {
  while (!queue_.empty() && !is_wanted(queue_.front())) pop_nearest();
  if (queue_.empty()) return std::nullopt;
  return queue_.front();
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
    if (!queue_.empty() && queue_.front() == key) pop_nearest();
    return;
  }
  chunks_.erase(key);
  queue_.push_back(key);
  std::push_heap(queue_.begin(), queue_.end(), later(*order_));
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
