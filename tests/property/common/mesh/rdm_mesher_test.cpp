// RDM is compared with the face oracle on random scenes. Most extents are small, so that a test run
// covers many scenes.
#include "common/mesh/rdm/rdm_mesher.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

// Returns the same voxels in another axis order, voxel by voxel.
RunChunk turned(const RunChunk& chunk, AxisOrder order) {
  RunChunk out = uniform_chunk(chunk.extent, kEmpty, order);
  const DenseChunk dense = DenseChunk::of(chunk);
  for (std::uint32_t i = 0; i < chunk.volume(); ++i) {
    const VoxelPos p = dense_pos(chunk.extent, order, i);
    if (const Material m = dense.at(p.x, p.y, p.z); m != kEmpty) fill(out, i, 1, m);
  }
  return out;
}

/// Returns scene i of ten thousand. Most are small; one in twenty has sides up to 64; one in a
/// hundred is flat with sides up to 128.
MeshScene scene_of_many(SplitMix64& rng, int i) {
  if (i % 100 != 50) return random_scene(rng, i % 20 == 0 ? 64 : i % 20 == 10 ? 20 : 10);
  const auto longest = static_cast<std::uint8_t>(rng.between(65, 128));
  const auto other = static_cast<std::uint8_t>(rng.between(8, 128));
  const auto least = static_cast<std::uint8_t>(rng.between(8, 10));
  const Extent turns[] = {
      {longest, other, least}, {least, longest, other}, {other, least, longest}};
  const Extent extent = turns[rng.below(3)];
  return scene_of_extent(rng, extent, random_order(rng));
}

TEST_CASE("random scenes mesh to the exposed faces, each once", "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 1);
  RdmScratch scratch;  // one for all: contents left by a scene would show in the next
  ChunkMesh mesh;
  std::set<AxisOrder> orders;
  std::size_t transparent_quads = 0;
  for (int scene_number = 0; scene_number < 10000; ++scene_number) {
    const MeshScene scene = scene_of_many(rng, scene_number);
    mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, mesh);
    const auto difference = scene_difference(scene, mesh);
    if (!difference) {
      orders.insert(scene.chunk.order);
      transparent_quads += mesh.transparent.quads.size();
      continue;
    }
    CAPTURE(Catch::rngSeed(), scene_number);
    FAIL(*difference);
  }
  CHECK(orders.size() == kAxisOrderCount);
  CHECK(transparent_quads > 0);
}

TEST_CASE("the largest and the flattest extents mesh to the exposed faces", "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 2);
  for (const Extent extent : {Extent{128, 8, 8}, Extent{8, 128, 9}, Extent{10, 8, 128},
                              Extent{128, 128, 8}, Extent{8, 127, 128}, Extent{65, 64, 63}}) {
    for (const AxisOrder order : kAxisOrders) {
      const MeshScene scene = scene_of_extent(rng, extent, order);
      CAPTURE(Catch::rngSeed(), extent.x, extent.y, extent.z, order);
      REQUIRE(scene_difference(scene, mesh_of(scene)).value_or("") == "");
    }
  }
}

TEST_CASE("meshes stay correct while a chunk is edited by fills", "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 3);
  RdmScratch scratch;
  ChunkMesh mesh;
  for (int round = 0; round < 60; ++round) {
    MeshScene scene = random_scene(rng, 12);
    for (int step = 0; step < 20; ++step) {
      const std::uint32_t first = rng.below(scene.chunk.volume());
      const std::uint32_t longest =
          std::min(scene.chunk.volume() - first, rng.below(2) == 0 ? 4u : 400u);
      fill(scene.chunk, first, 1 + rng.below(longest),
           static_cast<Material>(rng.below(kMeshMaterialCount)));
      mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, mesh);
      CAPTURE(Catch::rngSeed(), round, step);
      REQUIRE(scene_difference(scene, mesh).value_or("") == "");
    }
  }
}

TEST_CASE("all six axis orders mesh to the same unit faces", "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 4);
  for (int round = 0; round < 60; ++round) {
    MeshScene scene = random_scene(rng, 14);
    const std::vector<UnitFace> faces = unit_faces(mesh_of(scene));
    for (const AxisOrder order : kAxisOrders) {
      scene.chunk = turned(scene.chunk, order);
      CAPTURE(Catch::rngSeed(), round, order);
      REQUIRE(unit_faces(mesh_of(scene)) == faces);
    }
  }
}

TEST_CASE("the same scene meshes to the same quads in used and in fresh scratch",
          "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 5);
  RdmScratch used;
  ChunkMesh mesh;
  for (int round = 0; round < 300; ++round) {
    const MeshScene scene = random_scene(rng, 16);
    const ChunkMesh fresh = mesh_of(scene);
    mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), used, mesh);
    CAPTURE(Catch::rngSeed(), round);
    REQUIRE(mesh.opaque.quads == fresh.opaque.quads);
    REQUIRE(mesh.opaque.first == fresh.opaque.first);
    REQUIRE(mesh.transparent.quads == fresh.transparent.quads);
    REQUIRE(mesh.transparent.first == fresh.transparent.first);
  }
}

TEST_CASE("chunks of more materials than fit a byte mesh to the exposed faces",
          "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 7);
  RdmScratch scratch;
  ChunkMesh mesh;
  for (int round = 0; round < 40; ++round) {
    // Every fourth round has few materials: contents left by the other index type would show.
    const unsigned count = round % 4 == 3 ? 5 : kManyMaterialCount;
    const Extent extent = round % 10 == 0 ? Extent{65, 9, 12} : Extent{12, 9, 11};
    const MeshScene scene = scene_of_many_materials(rng, extent, count);
    mesh_rdm(scene.chunk, scene.pointers(), many_visibility(), scratch, mesh);
    CAPTURE(Catch::rngSeed(), round);
    REQUIRE(mesh_difference(mesh, extent, many_materials(), expected_faces(scene, many_materials()))
                .value_or("") == "");
  }
}

/// Meshes scenes with kept borders and compares the meshes with those from runs, and the borders
/// that the sweep makes with those that are read.
class KeptBordersTrial {
 public:
  /// Some of the borders are not kept.
  void run(const MeshScene& scene, const VisibilityTable& visibility, SplitMix64& rng) {
    MeshBorders borders{};
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      if (!scene.neighbours[d] || rng.below(5) == 0) continue;
      kept_[d].read(*scene.neighbours[d], visibility);
      borders[d] = &kept_[d];
    }
    ChunkBorders own, read;
    mesh_rdm(scene.chunk, scene.pointers(), borders, visibility, scratch_, mesh_, &own);
    read.read(scene.chunk, visibility);
    mesh_rdm(scene.chunk, scene.pointers(), visibility, plain_scratch_, plain_);
    REQUIRE(mesh_.opaque.quads == plain_.opaque.quads);
    REQUIRE(mesh_.opaque.first == plain_.opaque.first);
    REQUIRE(mesh_.transparent.quads == plain_.transparent.quads);
    REQUIRE(mesh_.transparent.first == plain_.transparent.first);
    REQUIRE(equal_borders(scene.chunk, own, read));
    count_turned(own, borders);
  }
  /// Returns how many borders with several transparent materials had their bits along another axis
  /// than the chunk.
  std::size_t mixed_and_turned() const { return mixed_and_turned_; }

 private:
  void count_turned(const ChunkBorders& own, const MeshBorders& borders) {
    for (std::size_t d = 0; d < kDirectionCount && !own.empty(); ++d) {
      const auto side = static_cast<Direction>(d);
      if (borders[d] == nullptr || borders[d]->empty()) continue;
      const Direction touching = opposite(side);
      if (borders[d]->transparent_materials(touching).size() > 1 &&
          borders[d]->bit_axis(touching) != own.bit_axis(side))
        ++mixed_and_turned_;
    }
  }

  RdmScratch scratch_, plain_scratch_;
  ChunkMesh mesh_, plain_;
  std::array<ChunkBorders, kDirectionCount> kept_;
  std::size_t mixed_and_turned_ = 0;
};

TEST_CASE(
    "kept borders of neighbours give the same quads as their runs, and the sweep makes equal ones",
    "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 8);
  KeptBordersTrial trial;
  for (int round = 0; round < 1500; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    trial.run(random_scene(rng, round % 100 == 0 ? 80 : 16), mesh_visibility(), rng);
  }
}

TEST_CASE("kept borders with several transparent materials give the same quads in any orientation",
          "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 9);
  KeptBordersTrial trial;
  for (const Extent extent : {Extent{32, 32, 32}, Extent{33, 32, 8}, Extent{64, 33, 9},
                              Extent{65, 64, 8}, Extent{97, 8, 9}}) {
    for (int round = 0; round < 10; ++round) {
      CAPTURE(Catch::rngSeed(), extent.x, round);
      // Noise of all materials of mesh tests, two of which are transparent.
      trial.run(scene_of_many_materials(rng, extent, kMeshMaterialCount), mesh_visibility(), rng);
      if (round < 3) trial.run(scene_of_many_materials(rng, extent), many_visibility(), rng);
    }
  }
  CHECK(trial.mixed_and_turned() > 30);
}

TEST_CASE("quads that lie side by side with one edge in common along the strip are one quad",
          "[mesh][property]") {
  // Strips are maximal: no two quads of one layer, rows and material touch end to end along the
  // strip axis. The strip axis depends on the order. So at least one of the two axes must be free
  // of such pairs in every direction.
  SplitMix64 rng(Catch::rngSeed() + 6);
  for (int round = 0; round < 200; ++round) {
    const MeshScene scene = random_scene(rng, 14);
    const ChunkMesh mesh = mesh_of(scene);
    for (unsigned d = 0; d < kDirectionCount; ++d) {
      bool u_splits = false;
      bool v_splits = false;
      for (unsigned layer = 0; layer < kSideMax; ++layer) {
        for (const QuadLayers* pass : {&mesh.opaque, &mesh.transparent}) {
          const auto quads = pass->layer(static_cast<Direction>(d), layer);
          for (const Quad a_bits : quads) {
            for (const Quad b_bits : quads) {
              const QuadFields a = unpack(a_bits);
              const QuadFields b = unpack(b_bits);
              if (a.material != b.material) continue;
              const std::array<int, 3> pa = {a.x, a.y, a.z};
              const std::array<int, 3> pb = {b.x, b.y, b.z};
              const auto u = static_cast<std::size_t>(u_axis_of(axis_of(a.direction)));
              const auto v = static_cast<std::size_t>(v_axis_of(axis_of(a.direction)));
              u_splits |= pa[v] == pb[v] && a.height == b.height && pa[u] + a.width == pb[u];
              v_splits |= pa[u] == pb[u] && a.width == b.width && pa[v] + a.height == pb[v];
            }
          }
        }
      }
      CAPTURE(Catch::rngSeed(), round, d);
      REQUIRE_FALSE((u_splits && v_splits));
    }
  }
}

}  // namespace
}  // namespace runstone::test
