// Veiled tile: the tile of eight children as servers store it and clients see it: built, then veiled.
// A veil depends on the axis order (common/tiles/veil.hpp). All tiles have the same one, so a tile
// depends on the voxels of its children alone, and not on the orders in which somebody holds them.
// Tiles of one order also need no turning when the level above is made of them.
#pragma once
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/veil.hpp"

namespace runstone {

/// The axis order of tiles: layers lie flat, as most ground does. docs/tiles.md compares the orders.
inline constexpr AxisOrder kTileOrder = AxisOrder::zxy;

/// The buffers that calls reuse. They belong to one thread.
struct VeiledTileScratch {
  TileScratch build;
  VeilScratch veil;
};

/// Turns a tile to kTileOrder and veils it.
RunChunk veiled(RunChunk tile, const VisibilityTable& visibility, VeiledTileScratch& scratch);

/// Returns the veiled tile of `children`, which are chunks or veiled tiles. Requires what
/// build_tile() requires. Thread: any, with one scratch each. Cost: that of build_tile() and veil();
/// O(1) if all children are empty.
RunChunk veiled_tile(const TileChildren& children, unsigned edge, const VisibilityTable& visibility,
                     VeiledTileScratch& scratch);

}  // namespace runstone
