// Remeshing of dirty layers is compared with a full mesh: the quads must be equal and in the same
// order.
#include <catch2/catch.hpp>

#include "tests/support/mesh/equal_quads.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

/// Changes one voxel or a stretch of the flattened chunk.
DirtyLayers change(SplitMix64& rng, RunChunk& chunk) {
  const std::uint32_t first = rng.below(chunk.volume());
  const std::uint32_t longest = std::min(chunk.volume() - first, rng.below(3) == 0 ? 200u : 1u);
  const std::uint32_t count = 1 + rng.below(longest);
  return fill_and_mark(chunk, first, count, static_cast<Material>(rng.below(kMeshMaterialCount)));
}

// Returns the number of steps that meshed only layers.
int edit_and_compare(SplitMix64& rng, MeshScene scene, int steps) {
  RdmScratch scratch;
  ChunkMesh mesh;
  ChunkMesh full;
  int by_layers = 0;
  mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, mesh);
  for (int step = 0; step < steps; ++step) {
    DirtyLayers dirty;
    std::array<DirtyLayers, kDirectionCount> beyond{};
    if (rng.below(4) != 0) dirty |= change(rng, scene.chunk);
    if (rng.below(3) == 0) {
      const auto d = static_cast<std::size_t>(rng.below(kDirectionCount));
      auto& neighbour = scene.neighbours.at(d);
      if (neighbour) beyond.at(d) = change(rng, *neighbour);
    }
    by_layers += mesh_rdm_layers(scene.chunk, scene.pointers(), mesh_visibility(), dirty, beyond,
                                 scratch, mesh)
                     ? 1
                     : 0;
    mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, full);
    CAPTURE(Catch::rngSeed(), step, scene.chunk.order);
    require_equal(mesh.opaque, full.opaque);
    require_equal(mesh.transparent, full.transparent);
  }
  return by_layers;
}

TEST_CASE("remeshed layers equal a full mesh, quad for quad, while chunk and neighbours are edited",
          "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 8);
  constexpr int kRounds = 300, kSteps = 12;
  int by_layers = 0;
  for (int round = 0; round < kRounds; ++round)
    by_layers += edit_and_compare(rng, random_scene(rng, 33), kSteps);
  CHECK(by_layers > kRounds * kSteps / 4);  // both paths are taken often
  CHECK(by_layers < kRounds * kSteps * 19 / 20);
}

TEST_CASE("remeshed layers equal a full mesh in the largest extents", "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 9);
  for (const Extent extent :
       {Extent{64, 64, 64}, Extent{128, 8, 33}, Extent{9, 128, 65}, Extent{33, 8, 128}}) {
    for (const AxisOrder order : kAxisOrders) {
      MeshScene scene;
      scene.chunk = random_chunk(rng, extent, order, kMeshMaterialCount);
      for (auto& neighbour : scene.neighbours) {
        neighbour = random_chunk(rng, extent, random_order(rng), kMeshMaterialCount, Shape::boxes);
      }
      edit_and_compare(rng, scene, 8);
    }
  }
}

}  // namespace
}  // namespace runstone::test
