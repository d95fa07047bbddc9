#include "server/map/map_threads.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "common/os/low_priority.hpp"

namespace runstone {

MapThreads::MapThreads(std::size_t count) {
  RUNSTONE_ASSERT(count > 0);
  for (std::size_t i = 0; i < count; ++i) threads_.emplace_back([this] { run(); });
}

MapThreads::~MapThreads() {
  {
    const std::lock_guard lock(mutex_);
    RUNSTONE_ASSERT(busy_.empty());
    is_stopping_ = true;
    ready_changed_.notify_all();
  }
  for (std::thread& thread : threads_) thread.join();
}

void MapThreads::wake(Map& map) {
  const std::lock_guard lock(mutex_);
  const auto [state, is_new] = busy_.try_emplace(&map);
  if (is_new) {
    ready_.push_back(&map);
    ready_changed_.notify_one();
  } else {
    state->second.is_woken = true;
  }
}

void MapThreads::leave(Map& map) {
  std::unique_lock lock(mutex_);
  const auto state = busy_.find(&map);
  if (state == busy_.end()) return;
  if (!state->second.is_running) {
    std::erase(ready_, &map);
    busy_.erase(state);
    return;
  }
  state->second.is_leaving = true;
  turn_ended_.wait(lock, [&] { return !busy_.contains(&map); });
}

void MapThreads::run() {
  lower_priority();
  lower_disk_priority();
  std::unique_lock lock(mutex_);
  for (;;) {
    ready_changed_.wait(lock, [this] { return !ready_.empty() || is_stopping_; });
    if (ready_.empty()) return;
    Map& map = *ready_.front();
    ready_.pop_front();
    State& state = busy_.at(&map);
    state.is_running = true;
    state.is_woken = false;
    lock.unlock();
    const bool has_more = map.turn();
    lock.lock();
    state.is_running = false;
    if (!state.is_leaving && (has_more || state.is_woken)) {
      ready_.push_back(&map);
      ready_changed_.notify_one();
      continue;
    }
    busy_.erase(&map);
    turn_ended_.notify_all();
  }
}

}  // namespace runstone
