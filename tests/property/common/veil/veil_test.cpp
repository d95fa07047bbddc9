// Veils of chunks against an oracle, on random ground. The test also checks the properties that a
// veil must not change.
#include "common/veil/veil.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "common/runs/reorder.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/support/veil/veil_oracle.hpp"

namespace runstone::test {
namespace {

VeilOracleRules rules_of(const VeilMaterials& materials, MissingSide missing) {
  return {
      [&materials](Material material) { return materials.covers[material] == Visibility::opaque; },
      missing == MissingSide::closed, materials.filler};
}

VeilMaterials mesh_veil() { return {mesh_visibility(), kStone}; }

/// Returns ground of several opaque materials with holes, in which most voxels are enclosed.
RunChunk speckled_ground(SplitMix64& rng, Extent extent) {
  RunChunk chunk = uniform_chunk(extent, kStone, random_order(rng));
  const std::uint32_t patches = rng.below(40);
  for (std::uint32_t i = 0; i < patches; ++i) {
    const std::uint32_t count = 1 + rng.below(rng.below(4) == 0 ? chunk.volume() / 4 : 40);
    fill(chunk, rng.below(chunk.volume() - count + 1), count,
         static_cast<Material>(6 + rng.below(5)));
  }
  const std::uint32_t holes = rng.below(12);
  for (std::uint32_t i = 0; i < holes; ++i) {
    const std::uint32_t count = 1 + rng.below(rng.below(4) == 0 ? chunk.volume() / 8 : 4);
    fill(chunk, rng.below(chunk.volume() - count + 1), count, static_cast<Material>(rng.below(6)));
  }
  return chunk;
}

/// Returns a chunk among neighbours, some of them missing, mostly ground.
MeshScene ground_scene(SplitMix64& rng, Extent extent) {
  MeshScene scene = scene_of_extent(rng, extent, random_order(rng));
  if (rng.below(4) != 0) scene.chunk = speckled_ground(rng, extent);
  for (auto& beyond : scene.neighbours) {
    const std::uint32_t kind = rng.below(5);
    if (kind == 0) {
      beyond.reset();
    } else if (kind < 4) {
      beyond = speckled_ground(rng, extent);
    }
  }
  return scene;
}

/// Returns the fewest runs in index order that any choice of covering materials for the enclosed
/// voxels can have: the sum over the stretches of enclosed voxels.
std::uint32_t fewest_runs(const DenseScene& scene, AxisOrder order, const VeilOracleRules& rules) {
  std::uint32_t runs = 0;
  std::optional<Material> last;  // of the last voxel that keeps its material
  bool is_free = false;          // an enclosed voxel lies behind it
  for (std::uint32_t i = 0; i < scene.chunk.extent().volume(); ++i) {
    const VoxelPos p = dense_pos(scene.chunk.extent(), order, i);
    if (oracle_encloses(scene, p, rules)) {
      is_free = true;
      continue;
    }
    const Material material = scene.chunk.at(p.x, p.y, p.z);
    const bool joins = rules.covers(material) || (last && rules.covers(*last));
    runs += !last || *last != material || (is_free && !joins) ? 1 : 0;
    runs += is_free && !joins ? 1 : 0;
    last = material;
    is_free = false;
  }
  return runs + (is_free && (!last || !rules.covers(*last)) ? 1 : 0);
}

}  // namespace

TEST_CASE("a veiled chunk among neighbours has the voxels of the oracle", "[veil][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  VeilScratch scratch;
  const VeilMaterials materials = mesh_veil();
  int changed = 0;
  for (int i = 0; i < 300; ++i) {
    const Extent extent = i % 60 == 0 ? random_extent(rng, kSideMax) : random_extent(rng, 20);
    const MeshScene scene = ground_scene(rng, extent);
    const MissingSide missing = i % 2 == 0 ? MissingSide::closed : MissingSide::open;
    const VeilOracleRules rules = rules_of(materials, missing);
    const DenseScene dense = DenseScene::of(scene.chunk, scene.pointers());
    const DenseChunk expected = oracle_veil(dense, scene.chunk.order, rules);
    CAPTURE(Catch::rngSeed(), i);
    const VeilBorders borders(scene.chunk, scene.pointers(), materials.covers, missing);
    const auto found = veiled(scene.chunk, borders, materials, scratch);
    REQUIRE(found.has_value() == !(expected == dense.chunk));
    if (i % 10 == 0)
      CHECK((found ? *found : scene.chunk).runs.size() ==
            fewest_runs(dense, scene.chunk.order, rules));
    if (!found) continue;
    ++changed;
    REQUIRE(validate(*found).has_value());
    REQUIRE(DenseChunk::of(*found) == expected);
    CHECK(found->runs.size() <= scene.chunk.runs.size());
    // A veil of a veiled chunk changes nothing.
    CHECK_FALSE(veiled(*found, borders, materials, scratch));
  }
  CHECK(changed > 100);
}

TEST_CASE("the veil of a chunk does not depend on the axis orders of its holder",
          "[veil][property]") {
  SplitMix64 rng{Catch::rngSeed() + 1};
  VeilScratch scratch;
  const VeilMaterials materials = mesh_veil();
  for (const unsigned edge : {8u, 16u, 32u, 64u, 128u}) {
    const MeshScene scene = ground_scene(rng, Extent::cube(edge));
    const RunChunk expected = veil_of(scene.chunk, scene.pointers(), materials, scratch);
    REQUIRE(validate(expected).has_value());
    CHECK(expected.order == kVeilOrder);
    for (const AxisOrder order : kAxisOrders) {
      MeshScene turned{reorder(scene.chunk, order), scene.neighbours};
      for (auto& beyond : turned.neighbours)
        if (beyond) beyond = reorder(*beyond, random_order(rng));
      CAPTURE(Catch::rngSeed(), edge, static_cast<int>(order));
      REQUIRE(veil_of(turned.chunk, turned.pointers(), materials, scratch) == expected);
    }
  }
}

TEST_CASE("a veil among neighbours changes no drawn face", "[veil][property]") {
  SplitMix64 rng{Catch::rngSeed() + 2};
  VeilScratch scratch;
  const VeilMaterials materials = mesh_veil();
  int changed = 0;
  for (int i = 0; i < 60; ++i) {
    MeshScene scene = ground_scene(rng, random_extent(rng));
    for (auto& beyond : scene.neighbours)
      if (!beyond) beyond = speckled_ground(rng, scene.chunk.extent);
    const std::vector<UnitFace> before = unit_faces(mesh_of(scene));
    RunChunk veil = veil_of(scene.chunk, scene.pointers(), materials, scratch);
    changed += DenseChunk::of(veil) == DenseChunk::of(scene.chunk) ? 0 : 1;
    scene.chunk = std::move(veil);
    CAPTURE(Catch::rngSeed(), i);
    REQUIRE(unit_faces(mesh_of(scene)) == before);
  }
  CHECK(changed > 20);
}

TEST_CASE("the veil tells nothing of enclosed voxels", "[veil][property]") {
  SplitMix64 rng{Catch::rngSeed() + 3};
  VeilScratch scratch;
  const VeilMaterials materials = mesh_veil();
  const VeilOracleRules rules = rules_of(materials, MissingSide::closed);
  for (int i = 0; i < 40; ++i) {
    const MeshScene scene = ground_scene(rng, random_extent(rng, 16));
    DenseScene dense = DenseScene::of(scene.chunk, scene.pointers());
    const RunChunk expected = veil_of(scene.chunk, scene.pointers(), materials, scratch);
    // Other covering materials in the enclosed voxels, chosen at random.
    RunChunk other = scene.chunk;
    for (VoxelIndex v = 0; v < other.volume(); ++v) {
      const LocalPos at = pos_of(v, other.extent, other.order);
      if (oracle_encloses(dense, {at.x, at.y, at.z}, rules))
        fill(other, v, 1, static_cast<Material>(6 + rng.below(50)));
    }
    CAPTURE(Catch::rngSeed(), i);
    REQUIRE(veil_of(other, scene.pointers(), materials, scratch) == expected);
  }
}

TEST_CASE("the oracle of veils finds a veil that hides walls or forgets neighbours",
          "[veil][property]") {
  SplitMix64 rng{Catch::rngSeed() + 4};
  const VeilMaterials materials = mesh_veil();
  const VeilOracleRules rules = rules_of(materials, MissingSide::closed);
  int found_walls = 0, found_neighbours = 0;
  for (int i = 0; i < 20; ++i) {
    const MeshScene scene = ground_scene(rng, random_extent(rng, 16));
    const DenseScene dense = DenseScene::of(scene.chunk, scene.pointers());
    const DenseChunk right = oracle_veil(dense, kVeilOrder, rules);
    found_walls += right == oracle_veil(dense, kVeilOrder, rules, VeilFault::hides_walls) ? 0 : 1;
    found_neighbours +=
        right == oracle_veil(dense, kVeilOrder, rules, VeilFault::forgets_neighbours) ? 0 : 1;
  }
  CHECK(found_walls > 0);
  CHECK(found_neighbours > 0);
}

}  // namespace runstone::test
