// TileMesh: the quads of a tile as a whole, and of each of its octants. Each of the nine bodies is
// closed: all opaque faces towards its outside are drawn. So no crack shows the sky, whatever
// stands next to it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "client/far/far_tiles.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"

namespace runstone {

struct TileMesh {
  ChunkMesh whole;
  /// One for each child of the tile, in the order of tile_child(), with places relative to the
  /// octant. Empty if they were not made.
  std::vector<ChunkMesh> octants;

  bool empty() const { return whole.empty(); }
  std::size_t quad_count() const;
};

struct FarMeshJob {
  ChunkKey key;
  std::uint64_t number = 0;  // rises with every job
  TilePtr tile;
  bool with_octants = false;
};

struct FarMeshResult {
  ChunkKey key;
  std::uint64_t number = 0;  // of the job
  std::int32_t edge = 0;     // voxels of the tile
  std::shared_ptr<const TileMesh> mesh;
};

/// Meshes a tile. Of the faces of transparent materials on the border of a body, the lower ones are
/// left out, because water would show them as walls, and so are the upper ones of an octant if the
/// octant above it goes on with the same material. Of the lateral ones only the waterline is kept:
/// the uppermost voxel. The water beside it may have another level and end up to a voxel lower.
/// Thread: any, with one scratch each.
FarMeshResult mesh_tile(const FarMeshJob& job, const VisibilityTable& visibility,
                        RdmScratch& scratch);

/// Removes the transparent faces of a chunk on its border in the lateral directions and the
/// downward one of `sides`, one bit for each Direction. Where distant ground continues the water of
/// a chunk, they would be walls in it. Returns true if there were any.
bool drop_water_walls(ChunkMesh& mesh, std::int32_t edge, std::uint8_t sides);

}  // namespace runstone
