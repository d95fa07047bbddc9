// Veil of a tile: replaces the materials of enclosed voxels, so that the runs of the tile are long
// (common/veil/veil.hpp has the rule). Tiles are never edited, so no face of an enclosed voxel is
// seen in the world. The client also draws octants, whose sides show enclosed voxels, so it veils
// each tile itself (client/far/far_planner.hpp). Servers veil tiles for the wire. They make tiles
// of tiles without a veil, because a voxel that is enclosed in one level may be seen in the next.
//
// The neighbours of a tile are not known: voxels on its border keep their material. So each line
// begins with a voxel that keeps its material, and an enclosed voxel shows the material that its
// predecessor in index order shows. No drawn face changes, whatever the neighbours of the tile are.
#pragma once
#include <optional>

#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/veil/veil.hpp"

namespace runstone {

/// Returns the tile with its veil, in the same axis order, or nullopt if the veil changes no voxel.
/// The result never has more runs than the tile. The veil of a veiled tile changes nothing.
/// Requires a valid tile of any extent. Thread: any, with one scratch each. In a steady state only
/// the result allocates. Cost: O(lines + runs).
std::optional<RunChunk> veiled(const RunChunk& tile, const VisibilityTable& visibility,
                               VeilScratch& scratch);

}  // namespace runstone
