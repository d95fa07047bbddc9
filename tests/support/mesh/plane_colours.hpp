// Plane colours: meshes in which a material tells the plane of a face in the world, so that a
// picture shows which plane each pixel belongs to. They serve to find pinholes: a mesh of merged
// quads and the same one cut into single faces must give equal pictures.
#pragma once
#include "common/core/coords.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/chunk_mesh.hpp"

namespace runstone {

/// Returns a table of opaque materials whose colours differ much and have no pattern.
const MaterialTable& plane_colours();

/// Returns the opaque quads of a mesh with a material of plane_colours() for each plane. If
/// `into_faces`, each quad is cut into its faces. `origin` is the first voxel of the chunk.
ChunkMesh coloured_by_plane(const ChunkMesh& mesh, VoxelPos origin, bool into_faces);

}  // namespace runstone
