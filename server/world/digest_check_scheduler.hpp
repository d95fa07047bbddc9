// Audit turns: digests of each session's chunks, recomputed from their runs and sent to be compared. Going round, every
// chunk of a session has its turn; and the sessions go round too, some on each tick, so that the audits of a crowd
// never hold up the edits that arrive meanwhile.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// The audits due now: every session once in audit_interval_us. O(their digests). Call on every tick.
void give_audit_turns(WorldState& world, const Clocks& now);

}  // namespace runstone
