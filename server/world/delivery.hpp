// Delivery: chunks on their way to sessions. Subscribing and taking the snapshot's version are one step here,
// so whatever commit comes after the snapshot reaches the session.
#pragma once
#include <string>

#include "server/world/world_state.hpp"

namespace runstone {

/// Sends the session's nearest wanted chunks: those in memory at once, the others after a load. Stops when
/// its queue is full or it waits for enough loads.
void deliver(WorldState& world, SessionId session, const Clocks& now);
/// Sends the uniform chunks that were gathered for the session. False: its queue is full, and they go on waiting.
bool send_uniform(WorldState& world, SessionId session, const Clocks& now);
/// What left the session's view and was not sent yet need not be.
void forget_unsent(WorldState& world, SessionId session);
/// Queues the snapshot of a wanted chunk, which gets the state `then`; without a chunk, the word that there is none. False:
/// the session's queue is full, and the chunk stays wanted.
bool answer_chunk(WorldState& world, SessionId session, const ChunkKey& key, const ChunkPtr& chunk,
                  ChunkInterest then, const Clocks& now);
/// The world itself needs a chunk: queues its load unless it is here, on its way or quarantined.
void ask_load(WorldState& world, const ChunkKey& key);
/// Hands queued loads to the port, as many as may be under way.
void start_loads(WorldState& world);
/// A load ended: whoever waits gets the chunk, or the word that it is unavailable.
void deliver_loaded(WorldState& world, const ChunkKey& key, const Clocks& now);
/// A commit did not fit the session's queue: these chunks are stale for it, are unsubscribed and will be sent
/// again as snapshots once the queue has room.
void mark_stale(WorldState& world, SessionId session, std::span<const ChunkKey> keys,
                const Clocks& now);
/// Hands chunks that lost their last user to eviction.
void collect_released(WorldState& world);

}  // namespace runstone
