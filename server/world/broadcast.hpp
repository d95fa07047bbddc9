// Broadcast: what the world strand tells many sessions. Each message is serialised once and the same bytes go
// to every receiver.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// Orders what is queued, hands it to the log, and sends each commit to the subscribers of the chunks it
/// touched and to the authors of its edits. O(subscribers of touched chunks).
void commit_and_broadcast(WorldState& world, const Now& now);
/// Tells every open session the durable sequence.
void broadcast_durable(WorldState& world);
/// Whole list to everybody, if it changed.
void broadcast_roster(WorldState& world);
/// Poses that changed since the last call, to everybody.
void broadcast_poses(WorldState& world);
/// Everybody's pose, to one who is new.
void send_all_poses_to(WorldState& world, SessionId session);
/// Some digests of each session's chunks, recomputed from their runs: going round, every chunk has its turn.
void send_audits(WorldState& world);

}  // namespace runstone
