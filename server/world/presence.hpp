// People: who is here and where they stand, told to everybody. In a crowd of n everything here could cost n * n, so
// the roster goes out as changes, and poses less often and some at a time: at 1,000 players two messages a second to
// each, of kPosesMax poses.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

inline constexpr std::size_t kPosesMax = 64;  // of a message; the others have the next turn
inline constexpr TimeUs kPoseIntervalUsPerSession =
    500;  // added up: the interval is at least this times the sessions

/// Who came and went since the last call, to everybody; the whole list to those who have none yet. A change that did
/// not fit makes up for it by the whole list on a later call.
void broadcast_roster(WorldState& world);
/// Poses that changed, to everybody, if their time has come; going round.
void broadcast_poses(WorldState& world, const Clocks& now);
/// Everybody's pose, to one who is new.
void send_all_poses_to(WorldState& world, SessionId session);

}  // namespace runstone
