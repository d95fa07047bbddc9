// Request steps: what an open session may ask for, but for its view (view_turns.hpp).
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// Chunks of the session's view are sent again; others are ignored.
void on_chunk_request(WorldState& world, SessionId session, const ChunkRequest& request,
                      const Clocks& now);
/// Queues the edit for the next commit or answers with a reject.
void on_edit(WorldState& world, SessionId session, const EditRequest& request, const Clocks& now);
void on_move(WorldState& world, SessionId session, const Move& move);
void on_ping(WorldState& world, SessionId session, const Ping& ping, const Clocks& now);

}  // namespace runstone
