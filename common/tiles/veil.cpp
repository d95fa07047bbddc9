#include "common/tiles/veil.hpp"

namespace runstone {

std::optional<RunChunk> veiled(const RunChunk& tile, const VisibilityTable& visibility,
                               VeilScratch& scratch) {
  if (tile.is_uniform()) return std::nullopt;
  // Each line begins with a voxel that keeps its material, so no voxel shows the filler.
  const VeilMaterials materials{visibility, kEmpty};
  return veiled(tile, VeilBorders(tile.extent, tile.order, MissingSide::open), materials, scratch);
}

}  // namespace runstone
