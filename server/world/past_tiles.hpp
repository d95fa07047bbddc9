// Past tiles: a session that sees the past gets the tiles of that moment. A tile below which nothing was
// edited since is the same at both times, so it is a present tile, as for the other sessions. Workers
// make the others, from the chunks as they were and from tiles that did not change. Such a tile is sent
// to one session, which is no receiver of its changes. It is neither kept nor stored, and has the digest
// 0, so that no client keeps it either. When the session moves in time or returns to the live world, the
// tiles that differ are sent again.
#pragma once
#include <cstddef>
#include <vector>

#include "server/world/tile_request.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

/// Past tiles with the workers at a time, for a session and for all together. A session that moves in
/// time leaves some behind; they count until they are answered.
inline constexpr std::size_t kPastTilesOfSessionMax = 4, kPastTilesMax = 16;
/// A request of a past tile stops after so many steps (TileRequest::steps_max), and n + 1 times as many
/// in the turn after the n-th. It goes on behind the others. A step makes a chunk as it was, or reads a
/// tile.
inline constexpr std::size_t kPastTileSteps = 64;

/// Makes the tiles wanted again that differ between the moment that the session saw before and the one
/// that it sees now (WorldSession::history). Call it when the session moved in time. Cost: a look-up for
/// each tile of the view's highest level, and for the children of each tile that differs.
void move_tiles_in_time(WorldState& world, SessionId session, const Clocks& now);
/// Returns true if the session sees the past and the tile of that moment differs from the present one.
/// Requires make_tiles_stale().
bool is_past_tile(const WorldState& world, const WorldSession& session, const ChunkKey& key);
/// Returns true if no past tile may be requested for the session at the moment. It is tried again on the
/// next tick.
bool waits_for_past_tiles(const WorldState& world, const WorldSession& session, const Clocks& now);
/// Gives a wanted tile to the workers, as it was. Requires is_past_tile() and not
/// waits_for_past_tiles().
void request_past_tile(WorldState& world, SessionId session, const ChunkKey& key,
                       const Clocks& now);
/// Handles the answer to WorldEnvironment::make_past_tile(): the tile, as the last one of `made`. If
/// `made` is empty, the tile could not be made. It is tried again after kTileRetryUs.
void on_past_tile_made(WorldState& world, SessionId session, const TileRequest& request,
                       const std::vector<MadeTile>& made, const Clocks& now);
/// Goes on with a request that has stopped, unless the session does not need it any more. Charges the
/// player for what was made.
void on_past_tile_stopped(WorldState& world, SessionId session, const TileRequest& request,
                          const std::vector<MadeTile>& made, const Clocks& now);

}  // namespace runstone
