// The guarantee of RdmScratch: once its buffers and the output have grown, meshing allocates
// nothing. The global operator new of this test program counts.
#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "common/mesh/rdm/rdm_mesher.hpp"
#include "tests/support/core/count_allocations.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

struct Place {
  MeshScene scene;
  const VisibilityTable* visibility = &mesh_visibility();
};

/// Two transparent materials on both sides of all borders, so that equal and different ones meet.
MeshScene scene_of_transparents(Extent extent) {
  MeshScene scene;
  const auto striped = [extent](std::uint32_t stripe) {
    RunChunk chunk = uniform_chunk(extent, kWater);
    for (std::uint32_t i = 0; i + stripe < chunk.volume(); i += 3 * stripe)
      fill(chunk, i, stripe, kGlass);
    return chunk;
  };
  scene.chunk = striped(1);
  for (auto& neighbour : scene.neighbours) neighbour = striped(2);
  return scene;
}

/// Scenes that together use every buffer: all widths of rows, both types of indices, borders where
/// transparent voxels meet.
std::vector<Place> places(SplitMix64& rng) {
  std::vector<Place> out;
  for (int i = 0; i < 40; ++i) out.push_back({random_scene(rng, 20)});
  for (const Extent extent : {Extent{128, 9, 12}, Extent{8, 128, 9}, Extent{10, 8, 128},
                              Extent{64, 9, 12}, Extent{8, 33, 9}}) {
    out.push_back({scene_of_extent(rng, extent, random_order(rng))});
    out.push_back({scene_of_many_materials(rng, extent), &many_visibility()});
    out.push_back({scene_of_transparents(extent)});
  }
  out.push_back({scene_of_many_materials(rng, {12, 9, 11}), &many_visibility()});
  out.push_back({scene_of_transparents({12, 9, 11})});
  return out;
}

TEST_CASE("aligned allocations are counted like others", "[mesh]") {
  struct alignas(64) Aligned {
    char bytes[64];
  };
  std::unique_ptr<Aligned> kept;
  const Allocations cost = allocations_of([&kept] { kept = std::make_unique<Aligned>(); });
  CHECK(reinterpret_cast<std::uintptr_t>(kept.get()) % 64 == 0);
  CHECK(cost.count == 1);
  CHECK(cost.bytes == 64);
}

TEST_CASE("meshing allocates nothing once scratch and output have grown", "[mesh]") {
  SplitMix64 rng(23);
  const std::vector<Place> all = places(rng);
  RdmScratch scratch;
  ChunkMesh mesh;
  for (const bool grown : {false, true}) {
    std::size_t counted = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto& [scene, visibility] = all[i];
      const MeshNeighbours around = scene.pointers();
      const auto cost =
          allocations_of([&] { mesh_rdm(scene.chunk, around, *visibility, scratch, mesh); });
      counted += cost.count;
      CAPTURE(i);
      if (grown) CHECK(cost.count == 0);
    }
    if (!grown) CHECK(counted > 0);  // the counter works
  }
}

TEST_CASE("meshing with kept borders, and making them, allocates nothing once all have grown",
          "[mesh]") {
  SplitMix64 rng(25);
  const std::vector<Place> all = places(rng);
  RdmScratch scratch;
  ChunkMesh mesh;
  ChunkBorders own;
  std::array<ChunkBorders, kDirectionCount> kept;
  for (const bool grown : {false, true}) {
    std::size_t counted = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto& [scene, visibility] = all[i];
      const MeshNeighbours around = scene.pointers();
      const auto cost = allocations_of([&] {
        MeshBorders borders{};
        for (std::size_t d = 0; d < kDirectionCount; ++d) {
          if (around[d] == nullptr) continue;
          kept[d].read(*around[d], *visibility);
          borders[d] = &kept[d];
        }
        mesh_rdm(scene.chunk, around, borders, *visibility, scratch, mesh, &own);
      });
      counted += cost.count;
      CAPTURE(i);
      if (grown) CHECK(cost.count == 0);
    }
    if (!grown) CHECK(counted > 0);
  }
}

TEST_CASE("remeshing layers allocates nothing once scratch and mesh have grown", "[mesh]") {
  SplitMix64 rng(24);
  MeshScene scene = random_scene(rng, 32);
  RdmScratch scratch;
  ChunkMesh mesh;
  const VisibilityTable& visibility = mesh_visibility();
  mesh_rdm(scene.chunk, scene.pointers(), visibility, scratch, mesh);
  // A voxel is placed and removed. The swap of buffers takes two rounds to grow both.
  const std::uint32_t voxel = scene.chunk.volume() / 2;
  const LocalPos at = pos_of(voxel, scene.chunk.extent, scene.chunk.order);
  DirtyLayers dirty;
  dirty.layer[0].set(at.x);
  dirty.layer[1].set(at.y);
  dirty.layer[2].set(at.z);
  std::size_t counted = 0;
  for (int round = 0; round < 12; ++round) {
    fill(scene.chunk, voxel, 1, round % 2 == 0 ? kStone : kWater);
    counted =
        allocations_of([&] {
          mesh_rdm_layers(scene.chunk, scene.pointers(), visibility, dirty, {}, scratch, mesh);
        }).count;
  }
  CHECK(counted == 0);
}

}  // namespace
}  // namespace runstone::test
