#include "server/world/presence.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

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
  const EncodedMessage encoded_change = encode_message(change);
  std::optional<EncodedMessage> encoded_full;  // made only if a session needs it
  for (const SessionId session : world.open_sessions()) {
    WorldSession& mine = *world.find(session);
    if (mine.has_player_list && !has_change) continue;
    if (!mine.has_player_list && !encoded_full)
      encoded_full = encode_message(full_player_list(world, entries));
    mine.has_player_list =
        send_or_skip(world, session, mine.has_player_list ? encoded_change : *encoded_full);
    if (!mine.has_player_list) world.player_list_changed = true;
  }
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
  const EncodedMessage encoded = encode_message(poses);
  for (const SessionId session : open) send_or_skip(world, session, encoded);
}

void send_all_poses_to(WorldState& world, SessionId session) {
  PlayerPoses poses;
  for (const auto& [id, other] : world.sessions) {
    if (other.state == SessionStage::open) poses.players.push_back({other.author, other.pose});
  }
  send_or_skip(world, session, encode_message(poses));
}

}  // namespace runstone
