// Remeshing of dirty layers is compared with a full mesh: the quads must be equal and in the same
// order.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

#include "common/mesh/rdm/layer_mesher.hpp"
#include "common/mesh/rdm/touched_layers.hpp"
#include "tests/support/mesh/equal_quads.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

/// Fills a box of voxels. A box of one voxel is as frequent as a plate, a bar or a large box.
DirtyLayers change_box(SplitMix64& rng, RunChunk& chunk) {
  const auto sides = chunk.extent.sides();
  std::array<std::uint32_t, 3> low{}, size{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = rng.below(sides[axis]);
    const std::uint32_t most = sides[axis] - low[axis];
    size[axis] = rng.below(2) == 0 ? 1 : 1 + rng.below(std::min(most, 9u));
    size[axis] = std::min(size[axis], most);
  }
  const auto material = static_cast<Material>(rng.below(kMeshMaterialCount));
  DirtyLayers dirty;
  for (std::uint32_t z = low[2]; z < low[2] + size[2]; ++z) {
    for (std::uint32_t y = low[1]; y < low[1] + size[1]; ++y) {
      for (std::uint32_t x = low[0]; x < low[0] + size[0]; ++x) {
        const LocalPos at = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                             static_cast<std::uint8_t>(z)};
        dirty |= fill_and_mark(chunk, index_of(at, chunk.extent, chunk.order), 1, material);
      }
    }
  }
  return dirty;
}

/// Changes one voxel, a box, or a stretch of the flattened chunk.
DirtyLayers change(SplitMix64& rng, RunChunk& chunk) {
  if (rng.below(3) == 0) return change_box(rng, chunk);
  const std::uint32_t first = rng.below(chunk.volume());
  const std::uint32_t longest = std::min(chunk.volume() - first, rng.below(3) == 0 ? 200u : 1u);
  const std::uint32_t count = 1 + rng.below(longest);
  return fill_and_mark(chunk, first, count, static_cast<Material>(rng.below(kMeshMaterialCount)));
}

/// Borders of neighbours, as a holder of chunks keeps some of them.
struct SomeBorders {
  /// Reads the borders of about half of the neighbours.
  SomeBorders(SplitMix64& rng, const MeshScene& scene) {
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      if (!scene.neighbours.at(d) || rng.below(2) == 0) continue;
      kept.at(d).read(*scene.neighbours.at(d), mesh_visibility());
      pointers.at(d) = &kept.at(d);
    }
  }
  std::array<ChunkBorders, kDirectionCount> kept;
  MeshBorders pointers{};
};

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
    const SomeBorders borders(rng, scene);
    by_layers += mesh_rdm_layers(scene.chunk, scene.pointers(), borders.pointers, mesh_visibility(),
                                 dirty, beyond, scratch, mesh)
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
  CHECK(by_layers < kRounds * kSteps * 49 / 50);
}

/// Meshes the layers of each edit, whatever it costs.
void edit_and_compare_layers(SplitMix64& rng, MeshScene scene, int steps, bool plain) {
  RdmScratch scratch, full_scratch;
  scratch.use_plain_path(plain);
  ChunkMesh mesh, full;
  mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, mesh);
  for (int step = 0; step < steps; ++step) {
    DirtyLayers dirty;
    std::array<DirtyLayers, kDirectionCount> beyond{};
    for (std::uint32_t i = rng.below(3); i != 0; --i) dirty |= change(rng, scene.chunk);
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      if (scene.neighbours.at(d) && rng.below(3) == 0)
        beyond.at(d) = change(rng, *scene.neighbours.at(d));
    }
    const rdm::TouchedLayers touched(scene.chunk, scene.pointers(), dirty, beyond);
    const MeshNeighbours around = scene.pointers();
    const SomeBorders borders(rng, scene);
    const auto observer = [](rdm::LayerStep) {};
    rdm::LayerMesher(scene.chunk, around, borders.pointers, mesh_visibility(), scratch.state(),
                     mesh, observer)
        .run(touched);
    mesh_rdm(scene.chunk, around, mesh_visibility(), full_scratch, full);
    CAPTURE(Catch::rngSeed(), step, plain, scene.chunk.order);
    require_equal(mesh.opaque, full.opaque);
    require_equal(mesh.transparent, full.transparent);
  }
}

TEST_CASE("layers meshed by a sweep equal a full mesh where a full mesh would cost less, too",
          "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 10);
  for (int round = 0; round < 400; ++round)
    edit_and_compare_layers(rng, random_scene(rng, 33), 8, round % 4 == 0);
  for (const Extent extent : {Extent{64, 64, 64}, Extent{128, 8, 33}, Extent{33, 8, 128}}) {
    for (const AxisOrder order : kAxisOrders)
      edit_and_compare_layers(rng, scene_of_extent(rng, extent, order), 4, false);
  }
}

TEST_CASE("remeshed layers equal a full mesh in the largest extents", "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 9);
  for (const Extent extent :
       {Extent{64, 64, 64}, Extent{128, 8, 33}, Extent{9, 128, 65}, Extent{33, 8, 128}}) {
    for (const AxisOrder order : kAxisOrders) {
      edit_and_compare(rng, scene_of_extent(rng, extent, order), 8);
    }
  }
}

}  // namespace
}  // namespace runstone::test
