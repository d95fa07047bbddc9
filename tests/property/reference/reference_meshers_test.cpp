// The reference meshers, compared with the oracle that also checks the product: exposed unit faces
// with material and direction, each covered once. Meshers that cull less are compared with the
// faces that they are to show.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "tests/reference/binary_greedy.hpp"
#include "tests/reference/material_octree.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/mesh/mesher_checks.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

using namespace reference;

TEST_CASE("random scenes: every reference mesher covers exactly its expected faces",
          "[mesh][property][reference]") {
  SplitMix64 rng(Catch::rngSeed() + 21);
  MesherChecks checks;
  std::set<AxisOrder> orders;
  int missing_neighbours = 0;
  int with_transparent = 0;
#ifdef RUNSTONE_SANITIZED
  constexpr int kScenes = 3000;
#else
  constexpr int kScenes = 10000;
#endif
  for (int scene_number = 0; scene_number < kScenes; ++scene_number) {
    const unsigned side_max = scene_number % 500 == 0 ? 40 : scene_number % 20 == 0 ? 20 : 10;
    const MeshScene scene = random_scene(rng, side_max);
    const std::string fault = checks.fault(scene);
    orders.insert(scene.chunk.order);
    with_transparent += checks.binary_mesh().transparent.quads.empty() ? 0 : 1;
    missing_neighbours +=
        std::count(scene.neighbours.begin(), scene.neighbours.end(), std::nullopt) != 0 ? 1 : 0;
    if (fault.empty()) continue;
    CAPTURE(Catch::rngSeed(), scene_number);
    FAIL(fault);
  }
  CHECK(orders.size() == kAxisOrderCount);
  CHECK(missing_neighbours > kScenes / 2);
  CHECK(missing_neighbours < kScenes);
  CHECK(with_transparent > kScenes / 4);
}

TEST_CASE("the largest and the flattest extents: every reference mesher",
          "[mesh][property][reference]") {
  SplitMix64 rng(Catch::rngSeed() + 22);
  MesherChecks checks;
  for (const Extent extent :
       {Extent{128, 8, 8}, Extent{8, 128, 9}, Extent{10, 8, 128}, Extent{64, 8, 8},
        Extent{8, 64, 9}, Extent{10, 8, 64}, Extent{64, 64, 8}, Extent{63, 62, 64}}) {
    for (const AxisOrder order : kAxisOrders) {
      const MeshScene scene = scene_of_extent(rng, extent, order);
      CAPTURE(Catch::rngSeed(), extent.x, extent.y, extent.z, order);
      REQUIRE(checks.fault(scene) == "");
    }
  }
}

TEST_CASE("shapes with a face on every voxel, and with none: every reference mesher",
          "[mesh][property][reference]") {
  SplitMix64 rng(Catch::rngSeed() + 23);
  MesherChecks checks;
  for (const ChunkShape shape :
       {ChunkShape::checkerboard, ChunkShape::noise, ChunkShape::uniform}) {
    for (const unsigned materials : {2u, 4u, kMeshMaterialCount}) {
      for (const AxisOrder order : kAxisOrders) {
        const Extent extent{33, 40, 31};
        MeshScene scene{random_chunk(rng, extent, order, materials, shape), {}};
        for (auto& neighbour : scene.neighbours) {
          neighbour = random_chunk(rng, extent, random_order(rng), materials, shape);
        }
        CAPTURE(Catch::rngSeed(), static_cast<int>(shape), materials, order);
        REQUIRE(checks.fault(scene) == "");
      }
    }
  }
}

TEST_CASE("random scenes: no mesher needs fewer quads than the optimum, and RDM few more",
          "[mesh][property][reference]") {
  // The checks compare the reference meshers with the optimum; the product is compared here.
  SplitMix64 rng(Catch::rngSeed() + 26);
  MesherChecks checks;
  std::size_t ours = 0;
  std::size_t least = 0;
  for (int round = 0; round < 1000; ++round) {
    const MeshScene scene = random_scene(rng, 20);
    CAPTURE(Catch::rngSeed(), round);
    REQUIRE(checks.fault_of_exposed(scene) == "");
    const std::size_t quads = mesh_of(scene).quad_count();
    REQUIRE(quads >= checks.optimal_quads());
    ours += quads;
    least += checks.optimal_quads();
  }
  CAPTURE(ours, least);
  CHECK(ours * 100 < least * 103);
}

TEST_CASE("binary greedy merges as well as the plain greedy count", "[mesh][property][reference]") {
  // The oracle counts widest first along u. The mesher's words may lie along u or v, so the totals
  // differ a little.
  SplitMix64 rng(Catch::rngSeed() + 24);
  std::size_t found = 0;
  std::size_t counted = 0;
  BinaryScratch scratch;
  ChunkMesh mesh;
  for (int round = 0; round < 200; ++round) {
    const MeshScene scene = random_scene(rng, 20);
    mesh_binary_greedy(grid_of(scene), mesh_visibility(), scratch, mesh);
    found += mesh.quad_count();
    counted += greedy_quad_count(expected_faces(scene));
  }
  CAPTURE(found, counted);
  CHECK(found * 100 < counted * 102);
  CHECK(counted * 100 < found * 102);
}

TEST_CASE("samples from an octree are the voxels around a chunk", "[mesh][property][reference]") {
  SplitMix64 rng(Catch::rngSeed() + 25);
  DenseGrid grid;
  for (int round = 0; round < 40; ++round) {
    // Eight chunks fill a cube of 64 from some odd place on. A window anywhere near it is sampled.
    const VoxelPos origin{rng.between(-100, 100), rng.between(-100, 100), rng.between(-100, 100)};
    MaterialOctree octree(origin, 2);
    std::vector<DenseChunk> chunks;
    for (int i = 0; i < 8; ++i) {
      const VoxelPos first{origin.x + 32 * (i & 1), origin.y + 32 * (i >> 1 & 1),
                           origin.z + 32 * (i >> 2)};
      const RunChunk chunk =
          random_chunk(rng, Extent::cube(32), random_order(rng), kMeshMaterialCount);
      octree.insert(first, chunk);
      chunks.push_back(DenseChunk::of(chunk));
    }
    const std::size_t loose_bytes = octree.byte_size();
    octree.compact();
    CHECK(octree.byte_size() <= loose_bytes);
    const auto at = [&](int x, int y, int z) {
      if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= 64) return kEmpty;
      return chunks[static_cast<std::size_t>(x / 32 + 2 * (y / 32) + 4 * (z / 32))].at(
          x % 32, y % 32, z % 32);
    };
    const VoxelPos low{rng.between(-20, 60), rng.between(-20, 60), rng.between(-20, 60)};
    const Extent extent = random_extent(rng, 40);
    grid.reset(extent, AxisOrder::xyz);
    octree.sample({origin.x + low.x, origin.y + low.y, origin.z + low.z}, grid);
    bool same = true;
    for (int z = -1; z <= extent.z; ++z) {
      for (int y = -1; y <= extent.y; ++y) {
        for (int x = -1; x <= extent.x; ++x)
          same &= grid.line(y, z)[x] == at(low.x + x, low.y + y, low.z + z);
      }
    }
    CAPTURE(Catch::rngSeed(), round);
    REQUIRE(same);
  }
}

}  // namespace
}  // namespace runstone::test
