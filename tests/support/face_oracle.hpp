// Face oracle: the exposed unit faces of a chunk by the plainest walk there is, and meshes taken apart into
// unit faces again. A mesh is right when both agree; how quads merge and in which order they come stays free.
// Shares no code with common/mesh beyond the types a mesh is made of: visibility comes from the material
// table, quads are unpacked here from their documented bits.
#pragma once
#include <array>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <span>
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

/// The six faces of every voxel that is drawn at all, sorted: what a mesher without culling shows
/// (thesis 4.2.3).
std::vector<UnitFace> all_faces(const DenseChunk& chunk, const MaterialTable& materials);

/// The faces that the thesis' RLE mesher shows (7.3.2), sorted. Seen along its index order z, y, x, a piece
/// is as many voxels of one line and material as lie together, and a drawn piece shows its two ends and its
/// sides +x and +y whole; its side -y unless the line before lies in the same slow layer and all voxels from
/// the one a line before the piece up to the piece are of its material; and its side -x unless all voxels
/// from the one a slow layer before are.
std::vector<UnitFace> tail_culled_faces(const DenseChunk& chunk, const MaterialTable& materials);

/// The faces shown by runs that hidden faces do not end (thesis 4.2.7), sorted: `exposed` ones (sorted), and of
/// each row of voxels of one material those behind the first of them. Rows lie along x for the faces of y sides,
/// along y for others.
std::vector<UnitFace> run_on_faces(const DenseChunk& chunk, const std::vector<UnitFace>& exposed);

/// The unit faces the quads of a mesh cover, sorted; a face covered twice stands there twice.
std::vector<UnitFace> unit_faces(const ChunkMesh& mesh);

/// Says what is wrong with the form of a mesh: grouping by direction and layer, quads that leave the extent,
/// reserved bits, corners that wind the wrong way, a material in the wrong pass, a face covered twice.
/// Nothing if all is well.
std::optional<std::string> mesh_fault(const ChunkMesh& mesh, Extent extent,
                                      const MaterialTable& materials);

/// mesh_fault(), or the first unit face that is missing or too many against `expected` (sorted).
std::optional<std::string> mesh_difference(const ChunkMesh& mesh, Extent extent,
                                           const MaterialTable& materials,
                                           const std::vector<UnitFace>& expected);

/// The same for a raw list of quads in any order: everything but grouping and passes.
std::optional<std::string> quads_difference(std::span<const Quad> quads, Extent extent,
                                            const MaterialTable& materials,
                                            const std::vector<UnitFace>& expected);

/// Quads of a simple greedy mesher over the same faces: per direction and layer, widest first, then as high
/// as it goes. The measure for how well quads merge.
std::size_t greedy_quad_count(const std::vector<UnitFace>& faces);

}  // namespace runstone::test
