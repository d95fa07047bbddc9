#include "server/world/presence.hpp"

#include <algorithm>
#include <map>
#include <string>

namespace runstone {
namespace {

/// Returns the names of the players with open sessions. Two clients of one player are one entry.
std::map<AuthorId, std::string> names_of(const WorldState& world) {
  std::map<AuthorId, std::string> names;
  for (const auto& [id, session] : world.sessions) {
    if (session.state == SessionStage::open) names[session.author] = session.name;
  }
  return names;
}

PlayerName entry_of(const WorldState& world, AuthorId author, const std::string& name) {
  return {author, name, world.players.key_of(author).value_or(PublicKey{})};
}

PlayerList full_player_list(const WorldState& world, const std::map<AuthorId, std::string>& names) {
  PlayerList list;
  list.players.reserve(names.size());
  for (const auto& [author, name] : names) list.players.push_back(entry_of(world, author, name));
  return list;
}

PlayerList change_between(const WorldState& world, const std::map<AuthorId, std::string>& before,
                          const std::map<AuthorId, std::string>& after) {
  PlayerList change;
  change.is_change = true;
  for (const auto& [author, name] : after) {
    const auto known = before.find(author);
    if (known == before.end() || known->second != name)
      change.players.push_back(entry_of(world, author, name));
  }
  for (const auto& [author, name] : before) {
    if (!after.contains(author)) change.left.push_back(author);
  }
  return change;
}

}  // namespace

void broadcast_player_list(WorldState& world) {
  if (!world.player_list_changed) return;
  world.player_list_changed = false;
  std::map<AuthorId, std::string> names = names_of(world);
  const PlayerList change = change_between(world, world.sent_player_list, names);
  const bool has_change = !change.players.empty() || !change.left.empty();
  const EncodedMessage encoded_change = encode_message(change);
  std::optional<EncodedMessage> encoded_full;  // made only if a session needs it
  for (const SessionId session : world.open_sessions()) {
    WorldSession& mine = *world.find(session);
    if (mine.has_player_list && !has_change) continue;
    if (!mine.has_player_list && !encoded_full)
      encoded_full = encode_message(full_player_list(world, names));
    mine.has_player_list =
        send_or_skip(world, session, mine.has_player_list ? encoded_change : *encoded_full);
    if (!mine.has_player_list) world.player_list_changed = true;
  }
  world.sent_player_list = std::move(names);
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
