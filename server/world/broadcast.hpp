// Broadcast: sends commits and the durable watermark to sessions. Each message is serialised once,
// and the same bytes go to every receiver.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// Orders the queued edits, appends them to the log, and sends each commit to the subscribers of
/// the chunks it touched and to the authors of its edits. Cost of each commit: O(edits + subscribers
/// of touched chunks + sessions), because the sessions of the authors are searched among all.
void commit_and_broadcast(WorldState& world, const Clocks& now);
/// Sends the durable watermark to the sessions whose client has edits that are not yet
/// acknowledged.
void send_durable_to_authors(WorldState& world);
/// Sends the durable watermark to every session, once in durable_interval_us. Sessions without
/// edits need it only to resume, so they do not get a message for every group commit of the log.
void broadcast_durable(WorldState& world, const Clocks& now);

}  // namespace runstone
