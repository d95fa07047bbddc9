// Held steps: a session says which chunks it holds, and is told instead of a snapshot that one is the same, or which
// edits it lacks. A claim waits until its chunk's turn comes. Then, in the step that subscribes the session, the chunk's
// version V of that moment decides, and whatever is sent means V: a snapshot at V, "the same" if the copy is at V, or the
// edits that lead from the copy to V. Commits behind V go to the session from that step on, so none is lost
// between, whichever form a worker finds shorter later.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// Takes the claims of chunks that have not been answered; a session with more than kClaimsPerSessionMax of them is closed
/// (flooding).
void on_cached_chunks(WorldState& world, SessionId session, const CachedChunks& held);
/// The answer to a claim of this chunk, if there is one that serves. Requires a chunk.
enum class HeldAnswer {
  none,    // no claim, or it does not serve: send a snapshot
  queued,  // the session is answered
  full,    // its queue is
};
HeldAnswer answer_held(WorldState& world, SessionId session, const ChunkKey& key,
                       const ChunkPtr& chunk);
/// Sends what is due of "the same": all of it, or, while more is to come (`is_more`), only a full message. False: the
/// session's queue is full, and the rest stays due.
bool send_same(WorldState& world, SessionId session, bool is_more);

}  // namespace runstone
