// Tile requests: what the workers need to make a tile.
#pragma once
#include "server/world/ground/loads.hpp"
#include "server/world/ground/tile_board.hpp"

namespace runstone {

/// Chunks that are loaded for one request of a tile because they have edits.
inline constexpr std::size_t kTileLoadsMax = 64;
/// A request of a tile stops after so many steps (TileRequest::steps_max). A tile that has stopped
/// n times gets n + 1 times as many, so that it is made at last even if the tiles of earlier
/// requests are forgotten meanwhile. A step takes up to a few hundred microseconds.
inline constexpr std::size_t kTileSteps = 512;

/// Returns a request for a tile. Collects the chunks below it that are newer in memory than on
/// disk. An absent one has edits that nobody has applied yet; then `head` is 0. Some of the absent
/// ones are loaded, so that the tile is complete when it is made again. Requires
/// TileBoard::mark_outdated().
TileRequest request_of(GroundBase& base, Loads& loads, const TileBoard& board, const ChunkKey& tile,
                       const Clocks& now);

}  // namespace runstone
