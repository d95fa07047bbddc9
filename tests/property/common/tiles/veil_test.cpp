// Veils against an oracle, and the drawn faces of tiles before and after.
#include "common/tiles/veil.hpp"

#include <catch2/catch.hpp>
#include <utility>
#include <vector>

#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/support/tiles/tile_oracle.hpp"

namespace runstone::test {
namespace {

/// Returns a chunk in which many voxels are enclosed: mostly opaque ground of several materials,
/// with some holes.
RunChunk ground_chunk(SplitMix64& rng, Extent extent, AxisOrder order) {
  RunChunk chunk = random_chunk(rng, extent, order, 3);
  const std::uint32_t patches = rng.below(60);
  for (std::uint32_t i = 0; i < patches; ++i) {
    const std::uint32_t count = 1 + rng.below(chunk.volume() / 4);
    const std::uint32_t first = rng.below(chunk.volume() - count + 1);
    fill(chunk, first, count, static_cast<Material>(6 + rng.below(5)));
  }
  const std::uint32_t holes = rng.below(20);
  for (std::uint32_t i = 0; i < holes; ++i)
    fill(chunk, rng.below(chunk.volume()), 1, static_cast<Material>(rng.below(6)));
  return chunk;
}

}  // namespace

TEST_CASE("a veiled chunk has the voxels of the oracle", "[tiles][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  VeilScratch scratch;
  int changed = 0;
  for (int i = 0; i < 400; ++i) {
    const Extent extent = i % 20 == 0 ? random_extent(rng, kSideMax) : random_extent(rng);
    const AxisOrder order = random_order(rng);
    const RunChunk chunk = i % 3 == 0 ? random_chunk(rng, extent, order, 2 + rng.below(10))
                                      : ground_chunk(rng, extent, order);
    const DenseChunk before = DenseChunk::of(chunk);
    const DenseChunk expected = expected_veil(before, order, mesh_materials());
    CAPTURE(Catch::rngSeed(), i, static_cast<int>(order));
    const auto found = veiled(chunk, mesh_visibility(), scratch);
    REQUIRE(found.has_value() == !(expected == before));
    if (!found) continue;
    ++changed;
    REQUIRE(validate(*found).has_value());
    REQUIRE(found->order == order);
    REQUIRE(DenseChunk::of(*found) == expected);
    CHECK(found->runs.size() <= chunk.runs.size());
    // A veil of a veiled chunk changes nothing.
    CHECK_FALSE(veiled(*found, mesh_visibility(), scratch));
  }
  CHECK(changed > 50);
}

TEST_CASE("a veil changes no drawn face, with any neighbours and without", "[tiles][property]") {
  SplitMix64 rng{Catch::rngSeed() + 1};
  VeilScratch scratch;
  int changed = 0;
  for (int i = 0; i < 120; ++i) {
    const Extent extent = random_extent(rng);
    MeshScene scene = scene_of_extent(rng, extent, random_order(rng));
    scene.chunk = ground_chunk(rng, extent, random_order(rng));
    if (i % 3 == 0) scene.neighbours = {};
    CAPTURE(Catch::rngSeed(), i);
    const std::vector<UnitFace> before = unit_faces(mesh_of(scene));
    if (auto found = veiled(scene.chunk, mesh_visibility(), scratch)) {
      scene.chunk = *std::move(found);
      ++changed;
    }
    REQUIRE(unit_faces(mesh_of(scene)) == before);
    REQUIRE_FALSE(scene_difference(scene, mesh_of(scene)).has_value());
  }
  CHECK(changed > 20);
}

TEST_CASE("the check of faces finds a visible voxel of another material", "[tiles][property]") {
  MeshScene scene = block_scene();
  const std::vector<UnitFace> before = unit_faces(mesh_of(scene));
  fill(scene.chunk, index_of({1, 2, 3}, Extent::cube(8), AxisOrder::xyz), 1, kDirt);
  CHECK_FALSE(unit_faces(mesh_of(scene)) == before);
}

}  // namespace runstone::test
