// Tile handlers: sessions get the tiles of their views, and get them again after edits. Workers make
// the tiles. Edits make the tiles above the touched chunks stale, in O(levels) for each chunk; a
// stale tile that sessions have is made again after a pause that grows with its level, and sent to
// them.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "server/world/tile_request.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

/// After this time a tile is tried again that could not be made, or that lacks edits of chunks that
/// are not in memory.
inline constexpr TimeUs kTileRetryUs = 1'000'000;
/// Chunks that are loaded for one request of a tile because they have edits.
inline constexpr std::size_t kTileLoadsMax = 64;
/// Claims of tiles that one call of request_tiles() answers. Each takes about a microsecond or two.
inline constexpr std::size_t kTileClaimsPerCall = 512;
/// Bytes that count as read for each claim of a tile, since it is answered without a load.
inline constexpr std::size_t kTileClaimBytes = 64;
/// A request of a tile stops after so many steps (TileRequest::steps_max). A tile that has stopped n
/// times gets n + 1 times as many, so that it is made at last even if the tiles of earlier requests are
/// forgotten meanwhile. A step takes up to a few hundred microseconds.
inline constexpr std::size_t kTileSteps = 512;
/// Tiles with the workers at a time.
inline constexpr std::size_t kTilesInFlightMax = 4;

/// Limits the levels of a view that the client sent to those that the server makes.
void limit_levels(const WorldState& world, const WorldSession& session, View& view);
/// Returns true if the server may use this claim of a tile: the session has tiles of its level, and
/// waits for this one or may wait for it later.
bool accepts_claim(const WorldState& world, const WorldSession& session, const ChunkKey& key);
/// Sends changed tiles to sessions that have them (tile_resends.hpp), as far as their pace allows. Cost:
/// O(kTileResendBurstUs / kTileResendUs) sends.
void resend_tiles(WorldState& world, const Clocks& now);
/// Moves a session's tiles to its view. `skipped`: as in TileInterest::set_view(). Returns the cost.
std::size_t set_tile_view(WorldState& world, SessionId session, const View& view,
                          std::span<const View> skipped);
/// Requests wanted tiles of the session, up to kTilesWaitingMax. A tile of which the session claims a
/// current copy is answered by "not modified", at most kTileClaimsPerCall of them.
void request_tiles(WorldState& world, SessionId session, const Clocks& now);
/// Returns a request for a tile. Collects the chunks below it that are newer in memory than on disk. An
/// absent one has edits that nobody has applied yet; then `head` is 0. Some of the absent ones are
/// loaded, so that the tile is complete when it is made again. Requires make_tiles_stale().
TileRequest request_of(WorldState& world, const ChunkKey& tile, const Clocks& now);
/// Gives tiles to the workers. Call it on each tick and after requests.
void start_tiles(WorldState& world, const Clocks& now);
/// Sends a tile that workers made, the last one of `made`, to the sessions that wait for it or have it
/// at an earlier state. Saves those that are worth it. `made` is empty if the tile could not be made.
void on_tiles_made(WorldState& world, const ChunkKey& key, const std::vector<MadeTile>& made,
                   const Clocks& now);
/// Saves tiles that were made on the way to a tile. The tile is requested again when others had their
/// turn.
void on_tile_stopped(WorldState& world, const ChunkKey& key, const std::vector<MadeTile>& made,
                     const Clocks& now);
/// Forgets the tiles of a session that ends.
void forget_tiles(WorldState& world, SessionId session, WorldSession& mine);

}  // namespace runstone
