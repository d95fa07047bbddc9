// TileMesh: the quads of a tile as a whole, and of each of its octants. Each of the nine bodies is
// closed: all faces towards its outside are drawn. So no crack shows the sky, whatever stands next
// to it.
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

/// Meshes a tile. Faces of transparent materials on the lower and lateral sides of a body are left
/// out, because water would show them as walls. Thread: any, with one scratch each.
FarMeshResult mesh_tile(const FarMeshJob& job, const VisibilityTable& visibility,
                        RdmScratch& scratch);

}  // namespace runstone
