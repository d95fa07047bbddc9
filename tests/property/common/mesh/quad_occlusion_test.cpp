// Occlusion is compared with an oracle that looks at three voxels for each corner of each face.
#include "common/mesh/occlusion/quad_occlusion.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "common/mesh/rdm/rdm_mesher.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

using Voxel3 = std::array<int, 3>;

/// A chunk and the 26 chunks around it, of which some are missing. Chunks at a side, an edge or a
/// corner may have other sides across it.
struct OcclusionScene {
  OcclusionScene(SplitMix64& rng, Extent extent) {
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      if (i != 13 && rng.below(4) == 0) continue;
      auto sides = extent.sides();
      std::size_t rest = i;
      for (std::uint8_t& side : sides) {
        if (rest % 3 != 1) side = static_cast<std::uint8_t>(rng.between(8, 20));
        rest /= 3;
      }
      const Extent of{sides[0], sides[1], sides[2]};
      chunks[i] = random_chunk(rng, of, random_order(rng), kMeshMaterialCount);
      dense[i] = DenseChunk::of(*chunks[i]);
    }
  }
  const RunChunk& middle() const { return *chunks[13]; }
  ChunksAround around() const {
    ChunksAround out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = chunks[i] ? &*chunks[i] : nullptr;
    return out;
  }
  MeshNeighbours neighbours() const {
    const ChunksAround all = around();
    return {all[around_place(-1, 0, 0)], all[around_place(1, 0, 0)],  all[around_place(0, -1, 0)],
            all[around_place(0, 1, 0)],  all[around_place(0, 0, -1)], all[around_place(0, 0, 1)]};
  }
  bool is_opaque(Voxel3 at) const {
    std::size_t which = 0, weight = 1;
    Voxel3 offset{};
    for (std::size_t axis = 0; axis < 3; ++axis, weight *= 3) {
      const int side = middle().extent.sides()[axis];
      offset[axis] = at[axis] < 0 ? -1 : at[axis] >= side ? 1 : 0;
      which += weight * static_cast<std::size_t>(offset[axis] + 1);
    }
    if (!dense[which]) return false;
    const DenseChunk& of = *dense[which];
    const Voxel3 sides = {of.side_x(), of.side_y(), of.side_z()};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (offset[axis] < 0) at[axis] += sides[axis];
      if (offset[axis] > 0) at[axis] -= middle().extent.sides()[axis];
    }
    return mesh_visibility()[of.at(at[0], at[1], at[2])] == Visibility::opaque;
  }

  std::array<std::optional<RunChunk>, 27> chunks;
  std::array<std::optional<DenseChunk>, 27> dense;
};

/// Returns the occlusion of a corner of the face of a voxel, at the lower or the higher end along u
/// and along v.
int expected_level(const OcclusionScene& scene, Voxel3 voxel, unsigned direction, bool high_u,
                   bool high_v) {
  const std::size_t w = direction / 2, u = (w + 1) % 3, v = (w + 2) % 3;
  voxel[w] += direction % 2 == 1 ? 1 : -1;
  Voxel3 along_u = voxel, along_v = voxel, diagonal = voxel;
  along_u[u] += high_u ? 1 : -1;
  along_v[v] += high_v ? 1 : -1;
  diagonal[u] = along_u[u];
  diagonal[v] = along_v[v];
  const int beside = scene.is_opaque(along_u) + scene.is_opaque(along_v);
  return beside == 2 ? 3 : beside + scene.is_opaque(diagonal);
}

/// Returns the first fault of cut quads, or nullopt.
std::optional<std::string> occlusion_fault(const OcclusionScene& scene, const OccludedQuads& out) {
  if (out.corners.size() != out.quads.quads.size()) return "another number of corners";
  for (std::size_t i = 0; i < out.corners.size(); ++i) {
    const QuadFields q = unpack(out.quads.quads[i]);
    const auto direction = static_cast<unsigned>(q.direction);
    const std::size_t w = direction / 2, u = (w + 1) % 3, v = (w + 2) % 3;
    // The values at low, at the end of u, at both ends, at the end of v.
    std::array<int, 4> at{};
    for (std::size_t corner = 0; corner < 4; ++corner)
      at[corner] = out.corners[i] >> (2 * corner) & 3;
    if (direction % 2 == 0) std::swap(at[1], at[3]);
    const bool is_level_u = at[0] == at[1] && at[2] == at[3];
    const bool is_level_v = at[0] == at[3] && at[1] == at[2];
    const std::string place = std::to_string(q.x) + " " + std::to_string(q.y) + " " +
                              std::to_string(q.z) + " to " + std::to_string(direction);
    if ((q.width > 1 && !is_level_u) || (q.height > 1 && !is_level_v))
      return "values that change along a long side at " + place;
    for (int b = 0; b < q.height; ++b) {
      for (int a = 0; a < q.width; ++a) {
        Voxel3 voxel = {q.x, q.y, q.z};
        voxel[u] += a;
        voxel[v] += b;
        for (unsigned corner = 0; corner < 4; ++corner) {
          const bool high_u = corner == 1 || corner == 2, high_v = corner >= 2;
          if (expected_level(scene, voxel, direction, high_u, high_v) != at[corner])
            return "another occlusion at " + place;
        }
      }
    }
  }
  return std::nullopt;
}

ChunkMesh cut_mesh(const OccludedQuads& opaque, const OccludedQuads& transparent) {
  ChunkMesh out;
  out.opaque = opaque.quads;
  out.transparent = transparent.quads;
  return out;
}

}  // namespace

TEST_CASE("cut quads give each corner of each face its occlusion", "[mesh][occlusion][property]") {
  SplitMix64 rng(Catch::rngSeed() + 951);
  RdmScratch scratch;
  ChunkMesh mesh;
  OpaqueBits bits;  // one for all scenes, so bits that stay from one scene would darken the next
  OccludedQuads opaque, transparent;
  std::map<int, std::size_t> corner_counts;
  for (int round = 0; round < 400; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const Extent extent = round % 40 == 0   ? Extent{8, 9, 70}
                          : round % 40 == 1 ? Extent{65, 8, 10}
                          : round % 40 == 2 ? Extent{9, 128, 8}
                                            : random_extent(rng, 16);
    const OcclusionScene scene(rng, extent);
    mesh_rdm(scene.middle(), scene.neighbours(), mesh_visibility(), scratch, mesh);
    bits.read(scene.middle(), scene.around(), mesh_visibility());
    occlude_quads(mesh.opaque, bits, opaque);
    occlude_quads(mesh.transparent, bits, transparent);
    REQUIRE(occlusion_fault(scene, opaque).value_or("") == "");
    REQUIRE(occlusion_fault(scene, transparent).value_or("") == "");
    // The faces are those of the mesh, each once, in the layers of the mesh.
    const ChunkMesh cut = cut_mesh(opaque, transparent);
    REQUIRE(mesh_difference(cut, extent, mesh_materials(), unit_faces(mesh)).value_or("") == "");
    for (const CornerOcclusion corners : opaque.corners) {
      for (std::size_t corner = 0; corner < 4; ++corner)
        ++corner_counts[occlusion_of(corners, corner)];
    }
  }
  for (int level = 0; level <= static_cast<int>(kOcclusionMax); ++level)
    CHECK(corner_counts[level] > 100);
}

TEST_CASE("the oracle of occlusion finds another value and a quad that is not cut",
          "[mesh][occlusion]") {
  SplitMix64 rng(7);
  OcclusionScene scene(rng, Extent::cube(8));
  for (auto& each : scene.chunks) each.reset();
  for (auto& each : scene.dense) each.reset();
  // A floor of 8 x 8 with one voxel upon it.
  RunChunk floor = uniform_chunk(Extent::cube(8), kEmpty, AxisOrder::xzy);
  fill(floor, 0, 64, kStone);
  fill(floor, 64 + 8 * 3 + 3, 1, kStone);
  scene.dense[13] = DenseChunk::of(floor);
  scene.chunks[13] = floor;
  RdmScratch scratch;
  ChunkMesh mesh;
  mesh_rdm(floor, {}, mesh_visibility(), scratch, mesh);
  OpaqueBits bits;
  bits.read(floor, {}, mesh_visibility());
  OccludedQuads out;
  occlude_quads(mesh.opaque, bits, out);
  REQUIRE_FALSE(occlusion_fault(scene, out));
  CHECK(out.quads.quads.size() > mesh.opaque.quads.size());
  OccludedQuads darker = out;
  darker.corners.back() ^= 1;
  CHECK(occlusion_fault(scene, darker));
  const OccludedQuads uncut{mesh.opaque, std::vector<CornerOcclusion>(mesh.opaque.quads.size(), 0)};
  CHECK(occlusion_fault(scene, uncut));
}

TEST_CASE("the diagonal of a quad joins the corners that are less dark", "[mesh][occlusion]") {
  const auto corners = [](unsigned a, unsigned b, unsigned c, unsigned d) {
    return static_cast<CornerOcclusion>(a | b << 2 | c << 4 | d << 6);
  };
  CHECK(first_corner(corners(0, 0, 0, 0)) == 0);
  CHECK(first_corner(corners(3, 0, 0, 0)) == 1);
  CHECK(first_corner(corners(0, 3, 0, 0)) == 0);
  CHECK(first_corner(corners(0, 0, 2, 0)) == 1);
  CHECK(first_corner(corners(0, 0, 0, 1)) == 0);
  CHECK(first_corner(corners(1, 2, 1, 0)) == 0);
}

}  // namespace runstone::test
