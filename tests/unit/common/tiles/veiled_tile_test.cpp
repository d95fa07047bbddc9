#include "common/tiles/veiled_tile.hpp"

#include <catch2/catch.hpp>

#include "common/runs/reorder.hpp"
#include "tests/support/mesh_scene.hpp"
#include "tests/support/random_chunk.hpp"

using namespace runstone;
using namespace runstone::test;

TEST_CASE("a veiled tile does not depend on the axis orders of its children", "[tiles]") {
  SplitMix64 rng(Catch::rngSeed());
  VeiledTileScratch scratch;
  for (int round = 0; round < 20; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    std::array<RunChunk, 8> children, turned;
    TileChildren pointers{}, turned_pointers{};
    for (std::size_t i = 0; i < 8; ++i) {
      children[i] = random_chunk(rng, Extent::cube(16), random_order(rng), 5);
      turned[i] = reorder(children[i], random_order(rng));
      pointers[i] = &children[i];
      turned_pointers[i] = &turned[i];
    }
    const RunChunk tile = veiled_tile(pointers, 16, mesh_visibility(), scratch);
    REQUIRE(validate(tile).has_value());
    REQUIRE(tile == veiled_tile(turned_pointers, 16, mesh_visibility(), scratch));
  }
}

TEST_CASE("a tile of empty children is uniform, and one of solid children keeps its material",
          "[tiles]") {
  VeiledTileScratch scratch;
  const Extent extent = Extent::cube(32);
  const RunChunk empty = uniform_chunk(extent, kEmpty, kTileOrder),
                 solid = uniform_chunk(extent, 1, kTileOrder);
  CHECK(veiled_tile({nullptr, &empty}, 32, mesh_visibility(), scratch) == empty);
  TileChildren children;
  children.fill(&solid);
  CHECK(veiled_tile(children, 32, mesh_visibility(), scratch) == solid);
}
