// Broadcast: sends commits and the durable watermark to sessions. A session gets the edits that
// concern it and no others. Sessions that get the same edits share one message.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// The large edits that a commit may have.
enum class LargeEdits { paced, all };

/// Orders the queued edits of one commit, appends them to the log, and sends each edit to the
/// subscribers of the chunks that it touched and to the session of its client. Returns false if no
/// edit is queued that may be ordered now.
/// Cost: O(edits + subscribers of touched chunks + sessions), because the sessions of the authors are
/// searched among all, and that of audiences_of().
bool commit_and_broadcast(WorldState& world, LargeEdits large, const Clocks& now);
/// Sends edits that were ordered to the sessions, and does what they make necessary for tiles and for
/// chunks that are not in memory.
void publish_batch(WorldState& world, const OrderedBatch& batch, const Clocks& now);
/// Returns true if commit_and_broadcast() with paced large edits would order edits.
bool has_ready_edits(const WorldState& world, TimeUs now_us);
/// Sends the durable watermark to the sessions whose client has edits that are not yet
/// acknowledged.
void send_durable_to_authors(WorldState& world);
/// Sends the durable watermark to every session, once in durable_interval_us. Sessions without
/// edits need it only to resume, so they do not get a message for every group commit of the log.
void broadcast_durable(WorldState& world, const Clocks& now);

}  // namespace runstone
