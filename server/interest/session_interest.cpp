#include "server/interest/session_interest.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {

std::vector<SessionInterest::Left> SessionInterest::set_view(const View& view) {
  std::vector<Left> left;
  if (view_ == view) return left;
  std::vector<ChunkCoord> cells;
  if (view_) {
    append_difference(*view_, view, limit_, cells);
    for (const ChunkCoord at : cells) {
      const ChunkKey key{0, at};
      const auto found = chunks_.find(key);
      RUNSTONE_ASSERT(found != chunks_.end());
      left.push_back({key, found->second});
      forget(key);
    }
    cells.clear();
  }
  append_difference(view, view_, limit_, cells);
  for (const ChunkCoord at : cells) {
    const ChunkKey key{0, at};
    chunks_.emplace(key, ChunkInterest::wanted);
    ++counter(ChunkInterest::wanted);
    queue_.push_back(key);
  }
  view_ = view;
  queue_sorted_ = false;
  return left;
}

void SessionInterest::forget(const ChunkKey& key) {
  const auto found = chunks_.find(key);
  --counter(found->second);
  chunks_.erase(found);
}

std::optional<ChunkKey> SessionInterest::nearest_wanted() {
  const auto is_wanted = [&](const ChunkKey& key) { return state(key) == ChunkInterest::wanted; };
  if (!queue_sorted_) {
    std::erase_if(queue_, [&](const ChunkKey& key) { return !is_wanted(key); });
    const auto farther = [&](const ChunkKey& a, const ChunkKey& b) {
      const std::int64_t da = distance2(*view_, a.at);
      const std::int64_t db = distance2(*view_, b.at);
      return da != db ? da > db : a > b;
    };
    std::sort(queue_.begin(), queue_.end(), farther);
    queue_sorted_ = true;
  }
  while (!queue_.empty() && !is_wanted(queue_.back())) queue_.pop_back();
  if (queue_.empty()) return std::nullopt;
  return queue_.back();
}

std::optional<ChunkInterest> SessionInterest::state(const ChunkKey& key) const {
  const auto found = chunks_.find(key);
  if (found == chunks_.end()) return std::nullopt;
  return found->second;
}

void SessionInterest::set_state(const ChunkKey& key, ChunkInterest state) {
  const auto found = chunks_.find(key);
  RUNSTONE_ASSERT(found != chunks_.end());
  if (found->second == state) return;
  --counter(found->second);
  ++counter(state);
  found->second = state;
  if (state == ChunkInterest::wanted) {
    queue_.push_back(key);
    queue_sorted_ = false;
  }
}

std::optional<ChunkKey> SessionInterest::next_for_audit() {
  if (count(ChunkInterest::subscribed) == 0) return std::nullopt;
  auto at = audited_ ? chunks_.upper_bound(*audited_) : chunks_.begin();
  for (std::size_t step = 0; step <= chunks_.size(); ++step) {  // one round at most: somebody is subscribed
    if (at == chunks_.end()) at = chunks_.begin();
    if (at->second == ChunkInterest::subscribed) {
      audited_ = at->first;
      return at->first;
    }
    ++at;
  }
  return std::nullopt;
}

}  // namespace runstone
