// Veiled tile: the tile of eight children as servers store it and clients see it: built, then
// veiled. A veil depends on the axis order (common/tiles/veil.hpp). It is made in the order that
// needs the fewest runs before the veil, so the voxels of a tile depend on the voxels of its
// children alone, and not on the orders in which somebody holds them.
#pragma once
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/veil.hpp"

namespace runstone {

/// The buffers that calls reuse. They belong to one thread.
struct VeiledTileScratch {
  TileScratch build;
  VeilScratch veil;
};

/// Brings a tile into its cheapest axis order (in_cheapest_order()) and veils it.
RunChunk veiled(RunChunk tile, const VisibilityTable& visibility, VeiledTileScratch& scratch);

/// Returns the veiled tile of `children`, which are chunks or veiled tiles. Requires what
/// build_tile() requires. Thread: any, with one scratch each. Cost: that of build_tile(), veil() and
/// in_cheapest_order(); O(1) if all children are empty.
RunChunk veiled_tile(const TileChildren& children, unsigned edge, const VisibilityTable& visibility,
                     VeiledTileScratch& scratch);

}  // namespace runstone
