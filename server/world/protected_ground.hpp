// Protected ground: sends each session what its player may do (Permissions) and the protected boxes
// near its view (ProtectedGround), so that its client predicts only edits that are allowed. A
// session knows at most kGroundBoxesMax boxes: those that overlap the cuboid of chunks around its
// view. If there are more, the cuboid is halved around the centre until they fit.
//
// A change only marks the sessions that it affects. On the next tick, each of them gets the
// difference to what it was sent. After kGroundBoxesPerTick compared boxes the other sessions wait
// for the next tick. A session whose queue is full is tried again on every tick. A session that
// looks at the past waits until it is back.
#pragma once
#include <cstddef>
#include <vector>

#include "server/world/world_state.hpp"

namespace runstone {

/// Boxes that are compared on one tick. The last session may exceed it.
inline constexpr std::size_t kGroundBoxesPerTick = 16'384;

/// Sends a session that has just opened its permissions.
void start_ground(WorldState& world, SessionId session);
/// The session's view has other chunks.
void mark_ground(WorldState& world, SessionId session);

/// Adds the ground that the change affects: that of the box before and after it. Call it before the
/// change is applied.
void add_changed_ground(const RightsState& rights, const RightsChange& change,
                        std::vector<VoxelBox>& ground);
/// Rights have changed, on this ground and for players in general. Cost: O(sessions * (log n +
/// ground)).
void rights_changed(WorldState& world, const std::vector<VoxelBox>& ground);

/// Sends what is due. Call it on every tick.
void send_due_ground(WorldState& world);

}  // namespace runstone
