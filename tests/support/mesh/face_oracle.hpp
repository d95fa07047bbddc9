// Face oracle: finds the exposed unit faces of a chunk by a plain walk, and takes meshes apart into
// unit faces. A mesh is right if both agree; merging and order of quads are free. It shares no code
// with common/mesh except the types of a mesh: visibility comes from the material table, and quads
// are unpacked here from their documented bits.
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
#include "tests/support/runs/dense_chunk.hpp"

namespace runstone::test {

struct UnitFace {
  int x = 0, y = 0, z = 0;  // of the solid voxel
  Direction direction = Direction::neg_x;
  Material material = kEmpty;
  friend auto operator<=>(const UnitFace&, const UnitFace&) = default;
};
std::ostream& operator<<(std::ostream& out, const UnitFace& face);

/// The neighbours by Direction. A missing neighbour is null and has only empty voxels.
using DenseNeighbours = std::array<const DenseChunk*, kDirectionCount>;

/// Returns the unit faces of one chunk, sorted. A neighbour has the chunk's sides across its
/// direction.
std::vector<UnitFace> exposed_faces(const DenseChunk& chunk, const DenseNeighbours& neighbours,
                                    const MaterialTable& materials);

/// Returns the six faces of every drawn voxel, sorted: what a mesher without culling shows (thesis
/// 4.2.3).
std::vector<UnitFace> all_faces(const DenseChunk& chunk, const MaterialTable& materials);

/// Returns the faces that the thesis' RLE mesher shows (7.3.2), sorted. Along its index order z, y,
/// x, a piece is the longest stretch of voxels of one line and material. A drawn piece shows:
/// - its two ends and its sides +x and +y whole;
/// - its side -y, unless the line before lies in the same slow layer and all voxels from one line
///   before the piece up to the piece have its material;
/// - its side -x, unless all voxels from one slow layer before the piece up to the piece have its
///   material.
std::vector<UnitFace> tail_culled_faces(const DenseChunk& chunk, const MaterialTable& materials);

/// Returns the faces of runs that hidden faces do not end (thesis 4.2.7), sorted: the `exposed`
/// ones (sorted), and of each row of voxels of one material those behind its first exposed face.
/// Rows lie along x for the faces of y sides, along y for others.
std::vector<UnitFace> run_on_faces(const DenseChunk& chunk, const std::vector<UnitFace>& exposed);

/// Returns the unit faces that the quads of a mesh cover, sorted. A face that is covered twice
/// occurs twice.
std::vector<UnitFace> unit_faces(const ChunkMesh& mesh);

/// Returns the fault in the form of a mesh, or nullopt if there is none: grouping by direction and
/// layer, quads that leave the extent, reserved bits, corners that wind the wrong way, a material
/// in the wrong pass, a face covered twice.
std::optional<std::string> mesh_fault(const ChunkMesh& mesh, Extent extent,
                                      const MaterialTable& materials);

/// Returns mesh_fault(), or the first unit face that is missing or too many compared with
/// `expected` (sorted).
std::optional<std::string> mesh_difference(const ChunkMesh& mesh, Extent extent,
                                           const MaterialTable& materials,
                                           const std::vector<UnitFace>& expected);

/// Does the same for a list of quads in any order: everything except grouping and passes.
std::optional<std::string> quads_difference(std::span<const Quad> quads, Extent extent,
                                            const MaterialTable& materials,
                                            const std::vector<UnitFace>& expected);

/// Returns the quads of a simple greedy mesher over the same faces: per direction and layer, widest
/// first, then as high as possible. It is the measure for how well quads merge.
std::size_t greedy_quad_count(const std::vector<UnitFace>& faces);

}  // namespace runstone::test
