#include "common/tiles/veiled_tile.hpp"

#include <algorithm>
#include <utility>

#include "common/runs/reorder.hpp"

namespace runstone {
RunChunk veiled(RunChunk tile, const VisibilityTable& visibility, VeiledTileScratch& scratch) {
  if (tile.order != kTileOrder) tile = reorder(tile, kTileOrder);
  veil(tile, visibility, scratch.veil);
  return tile;
}

RunChunk veiled_tile(const TileChildren& children, unsigned edge, const VisibilityTable& visibility,
                     VeiledTileScratch& scratch) {
  if (std::all_of(children.begin(), children.end(),
                  [](const RunChunk* child) { return child == nullptr || is_empty(*child); }))
    return uniform_chunk(Extent::cube(edge), kEmpty, kTileOrder);
  return veiled(build_tile(children, edge, kTileOrder, visibility, scratch.build), visibility,
                scratch);
}

}  // namespace runstone
