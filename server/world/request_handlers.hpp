// Request handlers: the messages of an open session that need no state of their own. Views are
// handled in view_scheduler.hpp, history requests in time_travel.hpp.
#pragma once
#include <cstddef>
#include <string>

#include "server/world/world_state.hpp"

namespace runstone {

/// Sends chunks of the session's view again. Chunks outside of it are ignored.
void on_chunk_request(WorldState& world, SessionId session, const ChunkRequest& request,
                      const Clocks& now);
/// Bytes that count as read for each rejection, so that messages that gain nothing do not keep the world
/// busy: with the default `read_kib_per_second`, a session gets some 220 rejections a second.
inline constexpr std::size_t kRejectionBytes = 4'096;
inline constexpr const char* kActionRefused = "an earlier edit of the same action was refused";
/// Describes what is wrong with a descriptor, for the author of the client.
std::string fault_text(const Error& fault);
/// Queues the edit for the next commit, or answers with a reject.
void on_edit(WorldState& world, SessionId session, const EditRequest& request, const Clocks& now);
/// Stores the player's pose; presence.hpp sends it.
void on_move(WorldState& world, SessionId session, const Move& move, const Clocks& now);
void on_ping(WorldState& world, SessionId session, const Ping& ping, const Clocks& now);

}  // namespace runstone
