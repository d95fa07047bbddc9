#include "server/world/ground/load_queue.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {

void LoadQueue::request(SessionId session, const ChunkKey& key) { lanes_[session].push_back(key); }

void LoadQueue::cancel(SessionId session, const ChunkKey& key) {
  const auto lane = lanes_.find(session);
  if (lane == lanes_.end()) return;
  std::erase(lane->second, key);
  if (lane->second.empty()) lanes_.erase(lane);
}

std::vector<ChunkKey> LoadQueue::cancel(SessionId session) {
  const auto lane = lanes_.find(session);
  if (lane == lanes_.end()) return {};
  std::vector<ChunkKey> keys(lane->second.begin(), lane->second.end());
  lanes_.erase(lane);
  return keys;
}

std::optional<LoadQueue::Next> LoadQueue::next_for_world() {
  if (in_flight_ >= in_flight_max_ || world_keys_.empty()) return std::nullopt;
  return Next{world_keys_.extract(world_keys_.begin()).value(), std::nullopt};
}

std::optional<LoadQueue::Next> LoadQueue::next(const std::set<SessionId>& must_wait) {
  if (in_flight_ >= in_flight_max_) return std::nullopt;
  const auto first_served = [&](auto lane) {
    return std::find_if(lane, lanes_.end(),
                        [&](const auto& one) { return !must_wait.contains(one.first); });
  };
  auto lane = first_served(last_served_ ? lanes_.upper_bound(*last_served_) : lanes_.begin());
  if (lane == lanes_.end() && world_keys_.empty()) lane = first_served(lanes_.begin());
  if (lane == lanes_.end()) {
    last_served_.reset();
    return next_for_world();
  }
  last_served_ = lane->first;
  const Next next{lane->second.front(), lane->first};
  lane->second.pop_front();
  if (lane->second.empty()) lanes_.erase(lane);
  return next;
}

void LoadQueue::load_ended() {
  RUNSTONE_ASSERT(in_flight_ > 0);
  --in_flight_;
}

}  // namespace runstone
