// VisibleVoxel: a random voxel with a visible face, at which a builder may edit.
#pragma once
#include "common/core/coords.hpp"
#include "common/core/hash.hpp"
#include "common/mesh/chunk_mesh.hpp"

namespace runstone::bench {

struct VisibleVoxel {
  VoxelPos at;
  Direction direction;  // of the face
};

/// Draws a random place of a random quad of cubes. Requires a mesh that has one.
VisibleVoxel draw_visible_voxel(const ChunkMesh& mesh, SplitMix64& rng);

}  // namespace runstone::bench
