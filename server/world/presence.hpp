// Presence: sends the list of players and their poses to every session. For n players this could
// cost n * n entries, so the list is sent as changes, and poses are sent less often and at most
// kPosesMax at a time. With 1,000 players each gets two messages of poses a second.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// Poses in one message. The next message continues with the other players.
inline constexpr std::size_t kPosesMax = 64;
/// The interval between two messages is at least this times the number of sessions.
inline constexpr TimeUs kPoseIntervalUsPerSession = 500;

/// Sends the changes of the player list since the last call to every session, and the full list to
/// sessions that have none. A session whose queue is full gets the full list on a later call.
void broadcast_player_list(WorldState& world);
/// Sends changed poses to every session if the interval has passed, round robin over the players.
void broadcast_poses(WorldState& world, const Clocks& now);
/// Sends the poses of all players to a new session.
void send_all_poses_to(WorldState& world, SessionId session);

}  // namespace runstone
