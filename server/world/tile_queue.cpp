#include "server/world/tile_queue.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {

void TileQueue::want(const ChunkKey& key, SessionId session) {
  Waiting& waiting = waiting_[key];
  RUNSTONE_ASSERT(std::ranges::find(waiting.sessions, session) == waiting.sessions.end());
  waiting.sessions.push_back(session);
  if (waiting.sessions.size() > 1 || in_flight_.contains(key)) return;
  waiting.place = Place{-int{key.lod}, requests_++, key};
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
}

void TileQueue::cancel_again(const ChunkKey& key) {
  const auto found = again_.find(key);
  if (found == again_.end()) return;
  due_.erase({found->second, key});
  again_.erase(found);
}

std::optional<ChunkKey> TileQueue::next(TimeUs now_us, std::size_t in_flight_max) {
  if (in_flight_.size() >= in_flight_max) return std::nullopt;
  std::optional<ChunkKey> key;
  if (!wanted_.empty()) {
    key = std::get<ChunkKey>(*wanted_.begin());
    wanted_.erase(wanted_.begin());
    waiting_.find(*key)->place.reset();
  } else {
    // A tile under way that is due again is made after it has finished.
    const auto due = std::ranges::find_if(
        due_, [&](const auto& one) { return !in_flight_.contains(one.second); });
    if (due == due_.end() || due->first > now_us) return std::nullopt;
    key = due->second;
  }
  cancel_again(*key);  // it is made now, with all edits so far
  in_flight_.insert(*key);
  return key;
}

void TileQueue::failed(const ChunkKey& key, TimeUs due_us) {
  const bool was_under_way = in_flight_.erase(key) != 0;
  RUNSTONE_ASSERT(was_under_way);
  make_again(key, due_us);
}

std::vector<SessionId> TileQueue::finished(const ChunkKey& key) {
  const bool was_under_way = in_flight_.erase(key) != 0;
  RUNSTONE_ASSERT(was_under_way);
  Waiting* waiting = waiting_.find(key);
  if (waiting == nullptr) return {};
  std::vector<SessionId> sessions = std::move(waiting->sessions);
  waiting_.erase(key);
  return sessions;
}

}  // namespace runstone
