// View scheduler: decides when a session's view takes effect. Only the newest view of a session
// waits. A session's view takes effect at most once in view_interval_us, and on one tick the views
// of all sessions visit at most view_chunks_per_tick chunks: those that they add or leave and those
// that are not sent yet (the last view may exceed it). So a
// client that moves its view a thousand times a second costs the world strand no more than one that
// moves it twenty times.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// Limits the radii to the server's maximum. The view takes effect at once or on a later tick.
void on_view(WorldState& world, SessionId session, View view, const Clocks& now);
/// Applies views that wait, round robin, until the tick's chunks are used up. Call it on every
/// tick.
void apply_due_views(WorldState& world, const Clocks& now);

}  // namespace runstone
