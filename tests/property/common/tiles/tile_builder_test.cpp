// Tiles against an oracle that counts the drawn faces of every voxel.
#include "common/tiles/tile_builder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "common/generate/generator.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/support/tiles/tile_oracle.hpp"

namespace runstone::test {
namespace {

/// Returns true if a tile is valid and has the voxels of the oracle.
bool is_expected(const RunChunk& tile, const Children& children, unsigned edge,
                 const MaterialTable& materials) {
  return validate(tile).has_value() &&
         DenseChunk::of(tile) == expected_tile(children, edge, materials);
}

/// Eight random children, some of them null, some in another order.
struct RandomChildren {
  std::array<RunChunk, 8> chunks;
  Children children{};

  RandomChildren(SplitMix64& rng, unsigned edge, AxisOrder order, unsigned materials) {
    const bool is_mixed = rng.below(4) == 0;
    for (std::size_t i = 0; i < 8; ++i) {
      if (rng.below(12) == 0) continue;
      const AxisOrder own = is_mixed ? random_order(rng) : order;
      chunks[i] = random_chunk(rng, Extent::cube(edge), own, materials);
      children[i] = &chunks[i];
    }
  }
};

}  // namespace

TEST_CASE("a tile of random children has the voxels of the oracle", "[tiles][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  TileScratch scratch;
  const auto check = [&](unsigned edge, int count) {
    for (int i = 0; i < count; ++i) {
      const bool has_many = rng.below(3) == 0;
      const AxisOrder order = random_order(rng);
      const unsigned materials = has_many ? kManyMaterialCount : 2 + rng.below(5);
      const RandomChildren some(rng, edge, order, materials);
      CAPTURE(Catch::rngSeed(), edge, i, static_cast<int>(order), materials);
      const RunChunk tile = build_tile(some.children, edge, order,
                                       has_many ? many_visibility() : mesh_visibility(), scratch);
      REQUIRE(tile.order == order);
      REQUIRE(
          is_expected(tile, some.children, edge, has_many ? many_materials() : mesh_materials()));
    }
  };
  check(16, 120);
  check(32, 24);
  check(64, 4);
  check(16, 4);
}

TEST_CASE("a tile of edge 128 has the voxels of the oracle", "[tiles][property]") {
  SplitMix64 rng{Catch::rngSeed() + 1};
  TileScratch scratch;
  const AxisOrder order = random_order(rng);
  const RandomChildren some(rng, 128, order, 6);
  CAPTURE(Catch::rngSeed(), static_cast<int>(order));
  const RunChunk tile = build_tile(some.children, 128, order, mesh_visibility(), scratch);
  REQUIRE(is_expected(tile, some.children, 128, mesh_materials()));
}

TEST_CASE("sparse voxels, thin sheets and see-through noise have the voxels of the oracle",
          "[tiles][property]") {
  SplitMix64 rng{Catch::rngSeed() + 2};
  TileScratch scratch;
  for (int i = 0; i < 40; ++i) {
    const unsigned edge = i % 8 == 0 ? 32 : 16;
    const AxisOrder order = random_order(rng);
    const std::uint32_t rarity = 1 + rng.below(40), period = 2 + rng.below(9);
    const std::uint64_t axis = rng.below(3);
    const ChildChunks children = children_of(edge, order, [&](int x, int y, int z) -> Material {
      const int along = axis == 0 ? x : axis == 1 ? y : z;
      const bool is_sheet = static_cast<std::uint32_t>(along) % period == 1;
      if (is_sheet) return static_cast<Material>(1 + static_cast<std::uint32_t>(along) % 5);
      return rng.below(rarity) == 0 ? static_cast<Material>(rng.below(6)) : kEmpty;
    });
    CAPTURE(Catch::rngSeed(), i, edge, static_cast<int>(order), rarity, period);
    const RunChunk tile = build_tile(children.pointers(), edge, order, mesh_visibility(), scratch);
    REQUIRE(is_expected(tile, children.pointers(), edge, mesh_materials()));
  }
}

TEST_CASE("tiles of generated terrain follow the oracle up to level 3", "[tiles][property]") {
  constexpr unsigned kEdge = 16;
  const MaterialTable& materials = default_material_table();
  const VisibilityTable visibility(visibilities(materials));
  const auto generator = make_generator({"terrain", 1, Catch::rngSeed(), ""}, materials);
  REQUIRE(generator.has_value());
  TileScratch scratch;
  const AxisOrder order = kAxisOrders[Catch::rngSeed() % kAxisOrderCount];
  // A cube of 8 x 8 x 8 chunks around the surface at the origin.
  const std::int32_t surface = (*generator)->surface_y(64, 64);
  std::vector<RunChunk> level;
  std::size_t side = 8;
  for (std::int32_t i = 0; i < 8 * 8 * 8; ++i) {
    const VoxelPos origin{i % 8 * 16, surface - 64 + i / 8 % 8 * 16, i / 64 * 16};
    level.push_back((*generator)->generate(origin, Extent::cube(kEdge)));
  }
  while (side > 1) {
    const auto below = [&](std::size_t x, std::size_t y, std::size_t z) {
      return &level[x + side * (y + side * z)];
    };
    const std::size_t half = side / 2;
    std::vector<RunChunk> tiles;
    for (std::size_t i = 0; i < half * half * half; ++i) {
      const std::size_t x = i % half, y = i / half % half, z = i / half / half;
      Children children{};
      for (std::size_t c = 0; c < 8; ++c)
        children[c] = below(2 * x + (c & 1), 2 * y + (c >> 1 & 1), 2 * z + (c >> 2));
      CAPTURE(Catch::rngSeed(), side, i);
      tiles.push_back(build_tile(children, kEdge, order, visibility, scratch));
      REQUIRE(is_expected(tiles.back(), children, kEdge, materials));
    }
    level = std::move(tiles);
    side = half;
  }
  CHECK_FALSE(level[0].is_uniform());
}

TEST_CASE("the check of tiles finds a tile with one wrong voxel", "[tiles][property]") {
  SplitMix64 rng{Catch::rngSeed() + 3};
  TileScratch scratch;
  const RandomChildren some(rng, 16, AxisOrder::xyz, 4);
  RunChunk tile = build_tile(some.children, 16, AxisOrder::xyz, mesh_visibility(), scratch);
  REQUIRE(is_expected(tile, some.children, 16, mesh_materials()));
  const std::uint32_t at = rng.below(tile.volume());
  const Material wrong = tile.runs.material(find_run(tile, at)) == 9 ? 8 : 9;
  fill(tile, at, 1, wrong);
  CHECK_FALSE(is_expected(tile, some.children, 16, mesh_materials()));
}

}  // namespace runstone::test
