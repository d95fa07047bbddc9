// Digest checks: the server recomputes digests of a session's chunks from their runs and sends
// them, and the client compares. Each check covers the session's next chunks, round robin. The
// sessions are served round robin too, a few on each tick, so that with many sessions the checks do
// not delay edits.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// Sends the digest checks that are due: one to every session in digest_check_interval_us. Call it
/// on every tick. Cost: O(their digests).
void send_due_digest_checks(WorldState& world, const Clocks& now);

}  // namespace runstone
