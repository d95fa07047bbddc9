// View turns: when a session's view takes effect. A view replaces the last one, so only the newest waits, and
// a session gets a turn at most every view_interval_us; all sessions together bring in no more than
// view_chunks_per_tick chunks in one tick (and one view more). So a peer that looks elsewhere a thousand
// times a second costs the world strand what one that does so twenty times costs, and edits go on in between.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// Cuts the radii to the server's limit; the view takes effect at once or on a later tick.
void on_view(WorldState& world, SessionId session, View view, const Clocks& now);
/// A new tick: views that wait take effect, going round, as far as the tick's chunks reach.
void give_view_turns(WorldState& world, const Clocks& now);

}  // namespace runstone
