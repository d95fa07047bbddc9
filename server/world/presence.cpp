#include "server/world/presence.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace runstone {
namespace {

using Entries = std::map<AuthorId, ListedEntry>;

/// Returns the players with open sessions. Two clients of one player are one entry.
Entries entries_of(const WorldState& world) {
  Entries entries;
  for (const auto& [id, session] : world.sessions) {
    if (session.state == SessionStage::open)
      entries[session.author] = {session.name, world.rights.role_of(session.key).name};
  }
  return entries;
}

PlayerName listed(const WorldState& world, AuthorId author, const ListedEntry& entry) {
  return {author, entry.name, world.players.key_of(author).value_or(PublicKey{}), entry.role};
}

PlayerList full_player_list(const WorldState& world, const Entries& entries) {
  PlayerList list;
  list.players.reserve(entries.size());
  for (const auto& [author, entry] : entries) list.players.push_back(listed(world, author, entry));
  return list;
}

PlayerList change_between(const WorldState& world, const Entries& before, const Entries& after) {
  PlayerList change;
  change.is_change = true;
  for (const auto& [author, entry] : after) {
    const auto known = before.find(author);
    if (known == before.end() || known->second != entry)
      change.players.push_back(listed(world, author, entry));
  }
  for (const auto& [author, entry] : before) {
    if (!after.contains(author)) change.left.push_back(author);
  }
  return change;
}

}  // namespace

void broadcast_player_list(WorldState& world) {
  if (!world.player_list_changed) return;
  world.player_list_changed = false;
  Entries entries = entries_of(world);
  const PlayerList change = change_between(world, world.sent_player_list, entries);
  const bool has_change = !change.players.empty() || !change.left.empty();
  std::vector<SessionId> get_change, get_full;
  for (const SessionId session : world.open_sessions()) {
    WorldSession& mine = *world.find(session);
    if (!std::exchange(mine.has_player_list, true)) {
      get_full.push_back(session);
    } else if (has_change) {
      get_change.push_back(session);
    }
  }
  const auto send_to = [&world](const std::vector<SessionId>& sessions, const PlayerList& list) {
    if (sessions.empty()) return;
    const auto full = world.output.send_to_all(sessions, encode_message(list));
    world.counters.queue_full += full.size();
    for (const SessionId session : full) {
      world.find(session)->has_player_list = false;
      world.player_list_changed = true;  // a later call sends them the whole list
    }
  };
  send_to(get_change, change);
  send_to(get_full, get_full.empty() ? PlayerList{} : full_player_list(world, entries));
  world.sent_player_list = std::move(entries);
}

void broadcast_poses(WorldState& world, const Clocks& now) {
  const std::vector<SessionId> open = world.open_sessions();
  const TimeUs interval = std::max(world.config.pose_interval_us,
                                   kPoseIntervalUsPerSession * static_cast<TimeUs>(open.size()));
  if (now.steady_us - world.poses_us < interval) return;
  world.poses_us = now.steady_us;
  PlayerPoses poses;
  const auto next = std::upper_bound(open.begin(), open.end(), world.pose_sent_last);
  const auto first = static_cast<std::size_t>(next - open.begin());
  for (std::size_t i = 0; i < open.size() && poses.players.size() < kPosesMax; ++i) {
    const SessionId id = open[(first + i) % open.size()];
    WorldSession& session = *world.find(id);
    if (!session.pose_changed) continue;
    session.pose_changed = false;
    world.pose_sent_last = id;
    poses.players.push_back({session.author, session.pose});
  }
  if (poses.players.empty()) return;
  world.counters.queue_full += world.output.send_to_all(open, encode_message(poses)).size();
}

void send_all_poses_to(WorldState& world, SessionId session) {
  PlayerPoses poses;
  for (const auto& [id, other] : world.sessions) {
    if (other.state == SessionStage::open) poses.players.push_back({other.author, other.pose});
  }
  send_or_skip(world, session, encode_message(poses));
}

}  // namespace runstone
