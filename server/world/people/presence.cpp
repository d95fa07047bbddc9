#include "server/world/people/presence.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace runstone {

/// Returns the players with open sessions. Two clients of one player are one entry.
Presence::Entries Presence::entries_now() const {
  Entries entries;
  for (const Session* session : sessions_.open())
    entries[session->author] = {session->name, rights_.state().role_of(session->key).name};
  return entries;
}

PlayerName Presence::listed(AuthorId author, const Entry& entry) const {
  return {author, entry.name, order_.players().key_of(author).value_or(PublicKey{}), entry.role};
}

PlayerList Presence::full_list(const Entries& entries) const {
  PlayerList list;
  list.players.reserve(entries.size());
  for (const auto& [author, entry] : entries) list.players.push_back(listed(author, entry));
  return list;
}

PlayerList Presence::change_between(const Entries& before, const Entries& after) const {
  PlayerList change;
  change.is_change = true;
  for (const auto& [author, entry] : after) {
    const auto known = before.find(author);
    if (known == before.end() || known->second != entry)
      change.players.push_back(listed(author, entry));
  }
  for (const auto& [author, entry] : before) {
    if (!after.contains(author)) change.left.push_back(author);
  }
  return change;
}

void Presence::enter(const Session& session, bool is_listed) {
  moved_.insert(session.id);
  has_list_changed_ |= is_listed;
}

void Presence::forget(const Session& session) {
  has_list_changed_ |= session.stage == SessionStage::open;
  have_list_.erase(session.id);
  moved_.erase(session.id);
}

void Presence::on_move(Session& session, const Move& move, const Clocks& now) {
  session.position.advance(session.pose.at, config_.speed_max, now.steady_us);
  if (session.pose == move.pose) return;
  session.pose = move.pose;
  moved_.insert(session.id);
}

void Presence::begin_anew() {
  has_list_changed_ = true;
  sent_.clear();
  have_list_.clear();
  for (const Session* session : sessions_.open()) moved_.insert(session->id);
}

void Presence::broadcast_player_list() {
  const bool have_rights_changed =
      std::exchange(rights_revision_, rights_.revision()) != rights_.revision();
  if (!std::exchange(has_list_changed_, false) && !have_rights_changed) return;
  Entries entries = entries_now();
  const PlayerList change = change_between(sent_, entries);
  const bool has_change = !change.players.empty() || !change.left.empty();
  std::vector<SessionId> get_change, get_full;
  for (const Session* session : sessions_.open()) {
    if (have_list_.insert(session->id).second) {
      get_full.push_back(session->id);
    } else if (has_change) {
      get_change.push_back(session->id);
    }
  }
  const auto send_to = [this](const std::vector<SessionId>& sessions, const PlayerList& list) {
    if (sessions.empty()) return;
    for (const SessionId session : sessions_.send_to_all(sessions, encode_message(list))) {
      have_list_.erase(session);
      has_list_changed_ = true;  // a later call sends them the whole list
    }
  };
  send_to(get_change, change);
  send_to(get_full, get_full.empty() ? PlayerList{} : full_list(entries));
  sent_ = std::move(entries);
}

void Presence::broadcast_poses(const Clocks& now) {
  const std::vector<Session*> open = sessions_.open();
  const TimeUs interval = std::max(config_.pose_interval_us,
                                   kPoseIntervalUsPerSession * static_cast<TimeUs>(open.size()));
  if (now.steady_us - poses_us_ < interval) return;
  poses_us_ = now.steady_us;
  PlayerPoses poses;
  const auto next = std::ranges::upper_bound(open, pose_sent_last_, {}, &Session::id);
  const auto first = static_cast<std::size_t>(next - open.begin());
  for (std::size_t i = 0; i < open.size() && poses.players.size() < kPosesMax; ++i) {
    const Session& session = *open[(first + i) % open.size()];
    if (moved_.erase(session.id) == 0) continue;
    pose_sent_last_ = session.id;
    poses.players.push_back({session.author, session.pose});
  }
  if (poses.players.empty()) return;
  std::vector<SessionId> readers;
  readers.reserve(open.size());
  for (const Session* session : open) readers.push_back(session->id);
  sessions_.send_to_all(readers, encode_message(poses));
}

void Presence::send_all_poses_to(const Session& session) {
  PlayerPoses poses;
  for (const Session* other : sessions_.open())
    poses.players.push_back({other->author, other->pose});
  sessions_.send_or_skip(session, encode_message(poses));
}

}  // namespace runstone
