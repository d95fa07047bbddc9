// Broadcast: how commits and the durable watermark reach sessions. Each message is serialised once and the same
// bytes go to every receiver.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// Orders what is queued, hands it to the log, and sends each commit to the subscribers of the chunks it
/// touched and to the authors of its edits. O(subscribers of touched chunks).
void commit_and_broadcast(WorldState& world, const Clocks& now);
/// Tells the durable sequence to the sessions that wait for edits of their own: at once.
void tell_durable_to_authors(WorldState& world);
/// Tells it to everybody, every durable_interval_us: the others need it for nothing but a resumption, and a crowd
/// would cost a message each for every group commit of the log.
void broadcast_durable(WorldState& world, const Clocks& now);

}  // namespace runstone
