// Delivery: sends chunks to sessions. A session is subscribed in the same call that takes the
// snapshot's version, so every commit after the snapshot reaches the session.
#pragma once
#include <string>

#include "server/world/world_state.hpp"

namespace runstone {

/// Sends the session's wanted chunks, nearest first: chunks in memory at once, the others after a
/// load. Stops when the session's queue is full or it waits for loads_per_session_max loads. After
/// some hundred chunks the session goes to WorldState::deliveries.
void deliver(WorldState& world, SessionId session, const Clocks& now);
/// Calls deliver() for the next session of WorldState::deliveries. Sessions take turns.
void deliver_next(WorldState& world, const Clocks& now);
/// Sends the uniform chunks that are due for the session, in one message for each level of detail.
/// Returns false if its queue is full; the chunks that are not sent stay due.
bool send_uniform(WorldState& world, SessionId session, const Clocks& now);
/// Returns true if the session's queue was full a moment ago.
bool is_stalled(const WorldState& world, const WorldSession& session, const Clocks& now);
/// Queues a chunk of one material to be sent together with others. Returns false if too many wait.
bool queue_uniform(WorldState& world, SessionId session, const ChunkKey& key, const Chunk& chunk,
                   const Clocks& now);
/// Returns the number of the session's view in force, or 0 before the first one. Answers carry it.
std::uint32_t view_in_force(const WorldState& world, SessionId session);
/// Describes the state of the world that the session sees.
ViewState view_state(const WorldState& world, SessionId session, ViewPhase phase);
/// Drops chunks that are queued for the session and lie outside of its view or will be answered
/// anew.
void forget_unsent(WorldState& world, SessionId session);
/// Queues a wanted chunk for the session and moves it to the state `then`. Sends "chunk
/// unavailable" if `chunk` is null. Returns false if the session's queue is full; the chunk stays
/// wanted.
bool send_chunk(WorldState& world, SessionId session, const ChunkKey& key, const ChunkPtr& chunk,
                ChunkInterest then, const Clocks& now);
/// Queues a load that the world itself needs. Does nothing unless the chunk is absent.
void request_load(WorldState& world, const ChunkKey& key, const Clocks& now);
/// Starts queued loads, up to loads_in_flight_max. A load for a session is paid by its player
/// (pay_load()).
void start_loads(WorldState& world, const Clocks& now);
/// Sends a loaded chunk, or "chunk unavailable", to the sessions that wait for it.
void deliver_loaded(WorldState& world, const ChunkKey& key, const Clocks& now);
/// Marks chunks as stale for a session because a commit did not fit its queue. The session is
/// unsubscribed from them and gets them again as snapshots when its queue has room.
void mark_stale(WorldState& world, SessionId session, std::span<const ChunkKey> keys,
                const Clocks& now);
/// Makes chunks that lost their last user candidates for eviction: some thousands, and the others
/// with the next calls.
void collect_released(WorldState& world);

}  // namespace runstone
