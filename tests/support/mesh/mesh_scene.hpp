// MeshScene: a chunk and its neighbours as a mesher's input, and the check of a mesher against the
// face oracle.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/core/hash.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/reference/dense_grid.hpp"
#include "tests/support/mesh/face_oracle.hpp"

namespace runstone::test {

/// The materials of mesh tests. Ids beyond them count as opaque.
inline constexpr Material kStone = 1, kDirt = 2, kWater = 3, kGlass = 4, kBarrier = 5;
inline constexpr unsigned kMeshMaterialCount = 6;
/// Returns the table: stone and dirt are opaque, water and glass transparent, and the barrier is a
/// named material that is not drawn.
const MaterialTable& mesh_materials();
const VisibilityTable& mesh_visibility();

/// More materials than fit a byte: ids 1 to 149 are opaque, 150 to 299 transparent.
inline constexpr unsigned kManyMaterialCount = 300;
const MaterialTable& many_materials();
const VisibilityTable& many_visibility();

struct MeshScene {
  RunChunk chunk;
  std::array<std::optional<RunChunk>, kDirectionCount> neighbours;  // by Direction
  MeshNeighbours pointers() const;
};

/// Returns a block of 2 x 3 x 4 stone at 1 2 3 with a voxel of water at 5 5 5, in a chunk of 8^3
/// without neighbours.
MeshScene block_scene();

/// Returns a seeded scene: any shapes, axis orders and extents (sides of the chunk up to
/// `side_max`). Each neighbour is there or missing, and has any depth along its direction.
MeshScene random_scene(SplitMix64& rng, unsigned side_max);

/// Returns a seeded scene of one extent: any shapes in the chunk, boxes in all six neighbours, in
/// any axis order.
MeshScene scene_of_extent(SplitMix64& rng, Extent extent, AxisOrder order);

/// Returns a seeded scene of one extent with the first `materials` of many_materials() as noise, in
/// which equal transparent ones meet. Some neighbours are missing, and one is the chunk itself.
/// Counts a dense expansion.
MeshScene scene_of_many_materials(SplitMix64& rng, Extent extent,
                                  unsigned materials = kManyMaterialCount);

/// Fills voxels of the flattened chunk. Returns the layers in which any voxel changed its material.
/// Requires first + count <= volume. Cost: O(count * log runs).
DirtyLayers fill_and_mark(RunChunk& chunk, VoxelIndex first, std::uint32_t count,
                          Material material);

/// Returns the oracle's faces of a scene. Counts dense expansions.
std::vector<UnitFace> expected_faces(const MeshScene& scene,
                                     const MaterialTable& materials = mesh_materials());

/// Returns the scene as the input of the dense meshers.
reference::DenseGrid grid_of(const MeshScene& scene);

/// Returns true if two borders agree on the sides of a chunk, and keep nothing if it is of one
/// material.
bool equal_borders(const RunChunk& chunk, const ChunkBorders& a, const ChunkBorders& b);

/// Returns the mesh of mesh_rdm() with scratch of its own.
ChunkMesh mesh_of(const MeshScene& scene);

/// Returns mesh_difference() of a mesh of the scene and the oracle.
std::optional<std::string> scene_difference(const MeshScene& scene, const ChunkMesh& mesh);

}  // namespace runstone::test
