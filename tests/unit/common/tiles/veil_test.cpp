#include "common/tiles/veil.hpp"

#include <catch2/catch.hpp>
#include <utility>

#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {
namespace {

constexpr Extent kExtent = Extent::cube(16);

RunChunk stone_chunk() { return uniform_chunk(kExtent, kStone, AxisOrder::xyz); }

void set(RunChunk& chunk, LocalPos at, Material material) {
  fill(chunk, index_of(at, chunk.extent, chunk.order), 1, material);
}

/// Veils a chunk. Returns true if that changes it.
bool veil(RunChunk& chunk) {
  VeilScratch scratch;
  auto changed = veiled(chunk, mesh_visibility(), scratch);
  if (changed) chunk = *std::move(changed);
  return changed.has_value();
}

}  // namespace

TEST_CASE("an enclosed voxel takes the material of its predecessor", "[tiles]") {
  RunChunk chunk = stone_chunk();
  set(chunk, {5, 5, 5}, kDirt);
  CHECK(veil(chunk));
  CHECK(chunk == stone_chunk());
  CHECK_FALSE(veil(chunk));
}

TEST_CASE("a uniform tile stays as it is", "[tiles]") {
  RunChunk chunk = stone_chunk();
  CHECK_FALSE(veil(chunk));
  CHECK(chunk == stone_chunk());
}

TEST_CASE("the walls of a cavity keep their materials", "[tiles]") {
  for (const Material inside : {kEmpty, kWater, kGlass, kBarrier}) {
    RunChunk chunk = stone_chunk();
    set(chunk, {5, 5, 5}, inside);
    set(chunk, {6, 5, 5}, kDirt);
    set(chunk, {4, 5, 5}, kDirt);
    set(chunk, {5, 6, 5}, kDirt);
    set(chunk, {5, 4, 5}, kDirt);
    set(chunk, {5, 5, 6}, kDirt);
    set(chunk, {5, 5, 4}, kDirt);
    const RunChunk before = chunk;
    veil(chunk);
    for (const LocalPos at : {LocalPos{6, 5, 5}, LocalPos{4, 5, 5}, LocalPos{5, 6, 5},
                              LocalPos{5, 4, 5}, LocalPos{5, 5, 6}, LocalPos{5, 5, 4}}) {
      CHECK(material_at(chunk, at) == kDirt);
    }
    CHECK(material_at(chunk, {5, 5, 5}) == inside);
    // The voxel behind a wall in index order is enclosed and takes its material.
    CHECK(material_at(chunk, {7, 5, 5}) == kDirt);
    CHECK(material_at(before, {7, 5, 5}) == kStone);
    CHECK(validate(chunk).has_value());
  }
}

TEST_CASE("voxels on the border of a tile keep their material", "[tiles]") {
  for (const std::uint8_t low : {std::uint8_t{0}, std::uint8_t{15}}) {
    for (const LocalPos at : {LocalPos{low, 5, 5}, LocalPos{5, low, 5}, LocalPos{5, 5, low}}) {
      RunChunk chunk = stone_chunk();
      set(chunk, at, kDirt);
      veil(chunk);
      CHECK(material_at(chunk, at) == kDirt);
    }
  }
}

TEST_CASE("a veil shortens the run list of speckled ground", "[tiles]") {
  RunChunk chunk = stone_chunk();
  for (std::uint8_t i = 1; i < 15; ++i) set(chunk, {i, i, i}, kDirt);
  const std::size_t runs = chunk.runs.size();
  CHECK(runs == 29);
  CHECK(veil(chunk));
  CHECK(chunk.runs.size() == 1);
}

}  // namespace runstone::test
