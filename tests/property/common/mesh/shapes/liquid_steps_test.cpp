#include "common/mesh/shapes/liquid_steps.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "common/mesh/chunk_mesher.hpp"
#include "common/runs/layer_diff.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {
namespace {

/// A side of a voxel.
using VoxelSide = std::tuple<int, int, int, Direction>;

/// Returns the sides that quads cover, and checks that none is covered twice. `counts` names the
/// rows that count, from the lowest.
template <class Counts>
std::set<VoxelSide> lateral_sides(std::span<const Quad> quads, const Counts& counts) {
  std::set<VoxelSide> out;
  for (const Quad quad : quads) {
    const QuadFields q = unpack(quad);
    const bool is_along_x = axis_of(q.direction) == Axis::x;
    if (axis_of(q.direction) == Axis::y || q.material != kWater) continue;
    const int height = is_along_x ? q.width : q.height, width = is_along_x ? q.height : q.width;
    for (int row = 0; row < height; ++row) {
      if (!counts(row, height)) continue;
      for (int i = 0; i < width; ++i)
        CHECK(out.insert({q.x + (is_along_x ? 0 : i), q.y + row, q.z + (is_along_x ? i : 0),
                          q.direction})
                  .second);
    }
  }
  return out;
}

/// The voxels of a scene, one by one.
struct SceneVoxels {
  const MeshScene& scene;

  /// Returns nullopt for a voxel that is in no chunk of the scene.
  std::optional<Material> at(int x, int y, int z) const {
    std::array<int, 3> place = {x, y, z};
    std::optional<std::size_t> beyond;
    const auto sides = scene.chunk.extent.sides();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (place[axis] >= 0 && place[axis] < sides[axis]) continue;
      if (beyond) return std::nullopt;
      beyond = 2 * axis + (place[axis] < 0 ? 0U : 1U);
    }
    const RunChunk* chunk = &scene.chunk;
    if (beyond) {
      if (!scene.neighbours[*beyond]) return std::nullopt;
      chunk = &*scene.neighbours[*beyond];
      const std::size_t axis = *beyond / 2;
      place[axis] = *beyond % 2 == 0 ? chunk->extent.sides()[axis] - 1 : 0;
    }
    return material_at(*chunk,
                       {static_cast<std::uint8_t>(place[0]), static_cast<std::uint8_t>(place[1]),
                        static_cast<std::uint8_t>(place[2])});
  }
  bool is_covered(int x, int y, int z) const {
    const auto above = at(x, y + 1, z);
    return above && (*above == kWater || mesh_visibility()[*above] == Visibility::opaque);
  }
};

MeshMaterials watery_materials() {
  MeshMaterials out(mesh_visibility());
  out.liquids.resize(kMeshMaterialCount);
  out.liquids[kWater] = true;
  return out;
}

}  // namespace

TEST_CASE("the lateral faces of a liquid are full exactly below covers, and gaps have steps",
          "[mesh][shapes][property]") {
  SplitMix64 rng(Catch::rngSeed() + 515);
  const MeshMaterials materials = watery_materials();
  ChunkMeshScratch scratch;
  ChunkMesh mesh, plain;
  std::size_t step_count = 0;
  for (int round = 0; round < 150; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const MeshScene scene = random_scene(rng, 16);
    mesh_chunk(scene.chunk, scene.pointers(), {}, materials, scratch, mesh);
    mesh_chunk(scene.chunk, scene.pointers(), {}, MeshMaterials(mesh_visibility()), scratch, plain);
    REQUIRE(mesh.opaque.quads == plain.opaque.quads);
    REQUIRE(mesh.transparent.quads == plain.transparent.quads);
    CHECK(plain.shapes.transparent.empty());
    CHECK(std::is_sorted(mesh.shapes.transparent.begin(), mesh.shapes.transparent.end(),
                         [](Quad a, Quad b) { return unpack(a).direction < unpack(b).direction; }));
    for (const Quad quad : mesh.shapes.transparent) CHECK(unpack(quad).face == kLiquidStepFace);
    const auto steps = lateral_sides(mesh.shapes.transparent, [](int, int) { return true; });
    const auto drawn = lateral_sides(mesh.transparent.quads, [](int, int) { return true; });
    const auto tops =
        lateral_sides(mesh.transparent.quads, [](int row, int h) { return row + 1 == h; });
    step_count += steps.size();
    const SceneVoxels voxels{scene};
    std::set<VoxelSide> expected;
    const Extent e = scene.chunk.extent;
    for (int x = 0; x < e.x; ++x) {
      for (int y = 0; y < e.y; ++y) {
        for (int z = 0; z < e.z; ++z) {
          if (voxels.at(x, y, z) != std::optional<Material>(kWater)) continue;
          const bool is_covered = voxels.is_covered(x, y, z);
          for (const Direction d :
               {Direction::neg_x, Direction::pos_x, Direction::neg_z, Direction::pos_z}) {
            const int step = is_positive(d) ? 1 : -1;
            const int bx = x + (axis_of(d) == Axis::x ? step : 0);
            const int bz = z + (axis_of(d) == Axis::z ? step : 0);
            const auto beside = voxels.at(bx, y, bz);
            const VoxelSide side{x, y, z, d};
            const bool towards_cover = !is_covered && beside == std::optional<Material>(kWater) &&
                                       voxels.is_covered(bx, y, bz);
            const bool lacks_edge = is_covered && beside && tops.contains(side);
            if (towards_cover || lacks_edge) expected.insert(side);
            // The edge that is lowered is that of the surface.
            if (drawn.contains(side) && !is_covered) CHECK(tops.contains(side));
          }
        }
      }
    }
    CHECK(steps == expected);
  }
  CHECK(step_count > 500);
}

TEST_CASE("steps join along a row, and follow edits of the chunk and of its neighbours",
          "[mesh][shapes]") {
  for (const AxisOrder order : kAxisOrders) {
    CAPTURE(order);
    // A pond of 6 x 6, half of it under a roof.
    RunChunk chunk = uniform_chunk(Extent::cube(16), kEmpty, order);
    const auto put = [](RunChunk& into, int x, int y, int z, Material material) {
      const LocalPos at{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                        static_cast<std::uint8_t>(z)};
      fill(into, index_of(at, into.extent, into.order), 1, material);
    };
    for (int x = 4; x < 10; ++x) {
      for (int z = 4; z < 10; ++z) {
        put(chunk, x, 4, z, kWater);
        if (x < 7) put(chunk, x, 5, z, kStone);
      }
    }
    const MeshMaterials materials = watery_materials();
    ChunkMeshScratch scratch;
    ChunkMesh mesh;
    mesh_chunk(chunk, {}, {}, materials, scratch, mesh);
    QuadFields to_roof;
    to_roof.x = 7, to_roof.y = 4, to_roof.z = 4;
    to_roof.height = 6;
    to_roof.direction = Direction::neg_x;
    to_roof.material = kWater;
    to_roof.face = kLiquidStepFace;
    CHECK(std::ranges::count(mesh.shapes.transparent, pack(to_roof)) == 1);
    // One more on each free side under the roof.
    CHECK(mesh.shapes.transparent.size() == 4);

    const RunChunk before = chunk;
    put(chunk, 6, 5, 6, kEmpty);
    mesh_chunk_layers(chunk, {}, {}, materials, changed_layers(before, chunk), {}, scratch, mesh);
    ChunkMesh whole;
    mesh_chunk(chunk, {}, {}, materials, scratch, whole);
    CHECK(mesh.shapes.transparent == whole.shapes.transparent);
    CHECK(std::ranges::count(mesh.shapes.transparent, pack(to_roof)) == 0);
    CHECK(mesh.shapes.transparent.size() ==
          4 + 4);  // the row in two, and three more around the gap
  }
}

}  // namespace runstone::test
