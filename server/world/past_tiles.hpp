// Past tiles: a session that sees the past gets the tiles of that moment. A tile below which nothing was
// edited since is the same in the past, so the session has it already or gets it like everybody. Workers
// make the others, from the chunks as they were and from tiles that did not change. Such a tile is sent
// to the one session, and is neither kept nor stored. When the session moves in time or returns to the
// live world, the tiles that differ are sent again.
#pragma once
#include <cstddef>
#include <vector>

#include "server/world/tile_request.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

/// Tiles of the past that workers make for a session at a time.
inline constexpr std::size_t kPastTilesLoadingMax = 4;

/// Makes the tiles wanted again that differ between the moment that the session saw before and the one
/// that it sees now (WorldSession::history). Call it when the session moved in time. Cost: a look-up
/// for each tile of the view whose parent differs.
void move_tiles_in_time(WorldState& world, SessionId session, const Clocks& now);
/// Returns true if the session sees the past and the tile of that moment differs from the present one.
/// Requires make_tiles_stale().
bool is_past_tile(const WorldState& world, const WorldSession& session, const ChunkKey& key);
/// Returns true if workers make the most tiles for the session that they may make at a time.
bool waits_for_past_tiles(const WorldSession& session);
/// Gives a wanted tile to the workers, as it was. Requires is_past_tile() and not
/// waits_for_past_tiles().
void request_past_tile(WorldState& world, SessionId session, const ChunkKey& key,
                       const Clocks& now);
/// Handles the answer to WorldEnvironment::make_past_tile(): the tile, as the last one of `made`. If
/// `made` is empty, the tile could not be made, and the session keeps what it has.
void on_past_tile_made(WorldState& world, SessionId session, HistoryNumber history,
                       const TileRequest& request, const std::vector<MadeTile>& made,
                       const Clocks& now);
/// Goes on with a request that has reached TileRequest::steps_max and brings what it made on the way.
void on_past_tile_stopped(WorldState& world, SessionId session, HistoryNumber history,
                          const TileRequest& request, const std::vector<MadeTile>& made,
                          const Clocks& now);

}  // namespace runstone
