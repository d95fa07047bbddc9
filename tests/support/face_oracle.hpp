// Face oracle: the exposed unit faces of a chunk by the plainest walk there is, and meshes taken apart into
// unit faces again. A mesh is right when both agree; how quads merge and in which order they come stays free.
// Shares no code with common/mesh beyond the types a mesh is made of: visibility comes from the material
// table, quads are unpacked here from their documented bits.
#pragma once
#include <array>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "tests/support/dense_chunk.hpp"

namespace runstone::test {

struct UnitFace {
  int x = 0, y = 0, z = 0;  // of the solid voxel
  Direction direction = Direction::neg_x;
  Material material = kEmpty;
  friend auto operator<=>(const UnitFace&, const UnitFace&) = default;
};
std::ostream& operator<<(std::ostream& out, const UnitFace& face);

/// By Direction; null means missing: nothing but empty voxels there.
using DenseNeighbours = std::array<const DenseChunk*, kDirectionCount>;

/// The unit faces of one chunk, sorted. A neighbour has the chunk's sides across its direction.
std::vector<UnitFace> exposed_faces(const DenseChunk& chunk, const DenseNeighbours& neighbours,
                                    const MaterialTable& materials);

/// The unit faces the quads of a mesh cover, sorted; a face covered twice stands there twice.
std::vector<UnitFace> unit_faces(const ChunkMesh& mesh);

/// Says what is wrong with the form of a mesh: grouping by direction and layer, quads that leave the extent,
/// reserved bits, a material in the wrong pass, a face covered twice. Nothing if all is well.
std::optional<std::string> mesh_fault(const ChunkMesh& mesh, Extent extent, const MaterialTable& materials);

/// mesh_fault(), or the first unit face that is missing or too many against `expected` (sorted).
std::optional<std::string> mesh_difference(const ChunkMesh& mesh, Extent extent,
                                           const MaterialTable& materials,
                                           const std::vector<UnitFace>& expected);

/// Quads of a simple greedy mesher over the same faces: per direction and layer, widest first, then as high
/// as it goes. The measure for how well quads merge.
std::size_t greedy_quad_count(const std::vector<UnitFace>& faces);

}  // namespace runstone::test
