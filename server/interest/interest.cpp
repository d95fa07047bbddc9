#include "server/interest/interest.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {

void Interest::open(SessionId session) {
  const bool is_new = sessions_.emplace(session, SessionInterest(limit_)).second;
  RUNSTONE_ASSERT(is_new);
}

void Interest::close(SessionId session) {
  const auto found = sessions_.find(session);
  if (found == sessions_.end()) return;
  for (const auto& [key, state] : found->second.chunks()) leave(session, key, state);
  sessions_.erase(found);
}

const SessionInterest* Interest::find(SessionId session) const {
  const auto found = sessions_.find(session);
  return found == sessions_.end() ? nullptr : &found->second;
}

SessionInterest& Interest::at(SessionId session) {
  const auto found = sessions_.find(session);
  RUNSTONE_ASSERT(found != sessions_.end());
  return found->second;
}

std::size_t Interest::set_view(SessionId session, const View& view) {
  const SessionInterest::Moved moved = at(session).set_view(view);
  for (const auto& left : moved.left) leave(session, left.key, left.was);
  return moved.steps;
}

template <class IsMeant>
std::size_t Interest::want_again(SessionId session, IsMeant is_meant) {
  std::vector<ChunkKey> again;
  for (const auto& [key, state] : at(session).chunks()) {
    if (is_meant(key.at)) again.push_back(key);
  }
  for (const ChunkKey& key : again) set_state(session, key, ChunkInterest::wanted);
  return again.size();
}

std::size_t Interest::want_all_again(SessionId session) {
  return want_again(session, [](ChunkCoord) { return true; });
}

std::size_t Interest::want_again_outside(SessionId session, std::span<const View> views) {
  return want_again(session, [views](ChunkCoord at) {
    return !std::all_of(views.begin(), views.end(),
                        [at](const View& view) { return view.contains(at); });
  });
}

std::optional<ChunkKey> Interest::nearest_wanted(SessionId session) {
  return at(session).nearest_wanted();
}

std::optional<ChunkKey> Interest::next_for_digest_check(SessionId session) {
  return at(session).next_for_digest_check();
}

bool Interest::set_state(SessionId session, const ChunkKey& key, ChunkInterest state) {
  SessionInterest& mine = at(session);
  const auto was = mine.state(key);
  if (!was) return false;
  if (*was == state) return true;
  mine.set_state(key, state);
  enter(session, key, state);
  leave(session, key, *was);
  return true;
}

void Interest::enter(SessionId session, const ChunkKey& key, ChunkInterest now) {
  if (now == ChunkInterest::subscribed) {
    std::vector<SessionId>& subscribers = users_[key].subscribers;
    subscribers.insert(std::lower_bound(subscribers.begin(), subscribers.end(), session), session);
  }
  if (now == ChunkInterest::waiting) users_[key].waiting.push_back(session);
}

void Interest::leave(SessionId session, const ChunkKey& key, ChunkInterest was) {
  if (was != ChunkInterest::subscribed && was != ChunkInterest::waiting) return;
  Users* users = users_.find(key);
  RUNSTONE_ASSERT(users != nullptr);
  std::erase(was == ChunkInterest::subscribed ? users->subscribers : users->waiting, session);
  if (users->subscribers.empty() && users->waiting.empty()) {
    users_.erase(key);
    released_.push_back(key);
  }
}

std::vector<ChunkKey> Interest::take_released(std::size_t count) {
  const auto end =
      released_.begin() + static_cast<std::ptrdiff_t>(std::min(count, released_.size()));
  std::vector<ChunkKey> out(released_.begin(), end);
  released_.erase(released_.begin(), end);
  return out;
}

std::span<const SessionId> Interest::subscribers(const ChunkKey& key) const {
  const Users* users = users_.find(key);
  if (users == nullptr) return {};
  return users->subscribers;
}

std::vector<SessionId> Interest::waiting(const ChunkKey& key) const {
  const Users* users = users_.find(key);
  if (users == nullptr) return {};
  return users->waiting;
}

bool Interest::subscribes(SessionId session, const ChunkKey& key) const {
  const SessionInterest* found = find(session);
  return found != nullptr && found->state(key) == ChunkInterest::subscribed;
}

}  // namespace runstone
