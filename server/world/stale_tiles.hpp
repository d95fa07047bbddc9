// Stale tiles: edits make the tiles above the touched chunks stale.
#pragma once
#include <span>

#include "server/world/world_state.hpp"

namespace runstone {

/// The tiles of level L are made again at most once in 2^(L - 1) of these times.
inline constexpr TimeUs kTileRemakeUs = 1'000'000;

/// Reports that a commit touched these chunks of level of detail 0, ascending, which have their new
/// versions. The tiles above them become stale with make_tiles_stale(), on a tick at the
/// latest. So edits of one chunk between two calls of it cost as much as one.
void tiles_edited(WorldState& world, std::span<const ChunkKey> chunks, const Clocks& now);
/// Makes the tiles stale above the chunks that were edited since the last call. Every function that
/// reads the state of tiles, or the newest edit below one, must call it first. Cost: O(edited chunks *
/// levels).
void make_tiles_stale(WorldState& world, const Clocks& now);

}  // namespace runstone
