// Cached chunk handlers: a client claims copies of chunks, and the server answers a claim with less
// than a snapshot where it can. A claim waits until its chunk is about to be sent. The answer is
// made in the call that subscribes the session, from the chunk's version V at that time. It is one
// of:
//   - "not modified", if the copy is at V;
//   - the edits that lead from the copy to V;
//   - a snapshot at V.
// From that call on, every commit behind V goes to the session, so no commit is lost, even if a
// worker chooses between edits and snapshot later.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// Stores the claims of chunks and tiles that were not sent yet. Claims of tiles are answered by the
/// tile handlers. Closes the session (flooding) if it has more
/// than kClaimsPerSessionMax claims.
void on_cached_chunks(WorldState& world, SessionId session, const CachedChunks& cached);

enum class ClaimReply {
  none,    // there is no claim, or it is of no use: send a snapshot
  queued,  // the reply is queued
  full,    // the session's queue is full
};
/// Replies to the session's claim of this chunk, if there is one. Requires a chunk.
ClaimReply reply_to_claim(WorldState& world, SessionId session, const ChunkKey& key,
                          const ChunkPtr& chunk);
/// Sends the "not modified" answers that are due. While more may follow (`is_more`), it sends only
/// full messages. Returns false if the session's queue is full; the rest stays due.
bool send_not_modified(WorldState& world, SessionId session, bool is_more);

}  // namespace runstone
