#include "server/world/ground/tile_queue.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {

void TileQueue::want(const ChunkKey& key, SessionId session) {
  Waiting& waiting = waiting_[key];
  RUNSTONE_ASSERT(std::ranges::find(waiting.sessions, session) == waiting.sessions.end());
  waiting.sessions.push_back(session);
  if (waiting.sessions.size() > 1 || in_flight_.contains(key)) return;
  waiting.place = Place{false, -int{key.lod}, requests_++, key};
  wanted_.insert(*waiting.place);
}

void TileQueue::make_again(const ChunkKey& key, TimeUs due_us) {
  if (again_.emplace(key, due_us).second) due_.insert({due_us, key});
}

void TileQueue::cancel(const ChunkKey& key, SessionId session) {
  Waiting* waiting = waiting_.find(key);
  if (waiting == nullptr) return;
  std::erase(waiting->sessions, session);
  if (!waiting->sessions.empty()) return;
  if (waiting->place) wanted_.erase(*waiting->place);
  waiting_.erase(key);
  if (!in_flight_.contains(key) && !again_.contains(key)) stops_.erase(key);
}

void TileQueue::cancel_again(const ChunkKey& key) {
  const auto found = again_.find(key);
  if (found == again_.end()) return;
  due_.erase({found->second, key});
  again_.erase(found);
  if (!in_flight_.contains(key) && !waiting_.contains(key)) stops_.erase(key);
}

std::optional<ChunkKey> TileQueue::next(TimeUs now_us, std::size_t in_flight_max) {
  if (in_flight_.size() >= in_flight_max) return std::nullopt;
  std::optional<ChunkKey> key;
  if (!wanted_.empty()) {
    auto first = wanted_.begin();
    const auto stopped = wanted_.lower_bound(Place{true, std::numeric_limits<int>::min(), 0, {}});
    if (stopped != wanted_.end() && std::exchange(is_turn_of_stopped_, !is_turn_of_stopped_))
      first = stopped;
    key = std::get<ChunkKey>(*first);
    wanted_.erase(first);
    waiting_.find(*key)->place.reset();
  } else if (now_us < changed_from_us_) {
    return std::nullopt;
  } else {
    // A tile under way that is due again is made after it has finished.
    const auto due = std::ranges::find_if(
        due_, [&](const auto& one) { return !in_flight_.contains(one.second); });
    if (due == due_.end() || due->first > now_us) return std::nullopt;
    key = due->second;
  }
  in_flight_.insert(*key);
  cancel_again(*key);  // it is made now, with all edits so far
  return key;
}

void TileQueue::stopped(const ChunkKey& key, TimeUs now_us) {
  const bool was_under_way = in_flight_.erase(key) != 0;
  RUNSTONE_ASSERT(was_under_way);
  ++stops_[key];
  if (Waiting* waiting = waiting_.find(key)) {
    waiting->place = Place{true, 0, requests_++, key};
    wanted_.insert(*waiting->place);
  } else {
    make_again(key, now_us);
  }
}

void TileQueue::failed(const ChunkKey& key, TimeUs due_us) {
  const bool was_under_way = in_flight_.erase(key) != 0;
  RUNSTONE_ASSERT(was_under_way);
  make_again(key, due_us);
}

std::vector<SessionId> TileQueue::finished(const ChunkKey& key) {
  const bool was_under_way = in_flight_.erase(key) != 0;
  RUNSTONE_ASSERT(was_under_way);
  stops_.erase(key);
  Waiting* waiting = waiting_.find(key);
  if (waiting == nullptr) return {};
  std::vector<SessionId> sessions = std::move(waiting->sessions);
  waiting_.erase(key);
  return sessions;
}

}  // namespace runstone
