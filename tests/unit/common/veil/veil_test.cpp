#include "common/veil/veil.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {
namespace {

constexpr Extent kVeilExtent = Extent::cube(8);
constexpr Material kOre = 6;

using Beyond = std::array<const RunChunk*, kDirectionCount>;

void set_voxel(RunChunk& chunk, LocalPos at, Material material) {
  fill(chunk, index_of(at, chunk.extent, chunk.order), 1, material);
}

RunChunk veil_among(const RunChunk& chunk, const Beyond& beyond) {
  VeilScratch scratch;
  return veil_of(chunk, beyond, {mesh_visibility(), kStone}, scratch);
}

}  // namespace

TEST_CASE("a chunk that is enclosed as a whole shows the filler alone", "[veil]") {
  RunChunk chunk = uniform_chunk(kVeilExtent, kDirt);
  set_voxel(chunk, {3, 4, 5}, kOre);
  const RunChunk rock = uniform_chunk(kVeilExtent, kOre);
  Beyond beyond;
  beyond.fill(&rock);
  const RunChunk filler = uniform_chunk(kVeilExtent, kStone, kVeilOrder);
  CHECK(veil_among(chunk, beyond) == filler);
  // A missing neighbour counts as closed.
  CHECK(veil_among(chunk, {}) == filler);
}

TEST_CASE("a voxel on the border keeps its material only where its neighbour does not cover it",
          "[veil]") {
  const RunChunk rock = uniform_chunk(kVeilExtent, kStone);
  RunChunk hollow = rock;
  set_voxel(hollow, {0, 3, 3}, kWater);
  RunChunk chunk = uniform_chunk(kVeilExtent, kDirt);
  set_voxel(chunk, {7, 3, 3}, kOre);
  set_voxel(chunk, {7, 3, 4}, kOre);
  Beyond beyond;
  beyond.fill(&rock);
  beyond[static_cast<std::size_t>(Direction::pos_x)] = &hollow;
  const RunChunk veil = veil_among(chunk, beyond);
  // Only one voxel can be seen. It gives its material to all others.
  CHECK(material_at(veil, {7, 3, 3}) == kOre);
  CHECK(veil.is_uniform());
}

TEST_CASE("a line that begins with enclosed voxels behind air shows what follows", "[veil]") {
  // Rock with a covered side at z = 0 and air above it: in the order zxy each line of rock begins
  // enclosed, behind the air at the end of the line before.
  const RunChunk rock = uniform_chunk(kVeilExtent, kStone);
  RunChunk chunk = uniform_chunk(kVeilExtent, kDirt, kVeilOrder);
  for (std::uint8_t y = 0; y < 8; ++y)
    for (std::uint8_t x = 0; x < 8; ++x) {
      set_voxel(chunk, {x, y, 0}, kOre);
      set_voxel(chunk, {x, y, 7}, kEmpty);
    }
  Beyond beyond;
  beyond.fill(&rock);
  const RunChunk veil = veil_among(chunk, beyond);
  for (std::uint8_t y = 0; y < 8; ++y)
    for (std::uint8_t x = 0; x < 8; ++x) {
      CHECK(material_at(veil, {x, y, 0}) == kDirt);
      CHECK(material_at(veil, {x, y, 7}) == kEmpty);
    }
  CHECK(veil.runs.size() == 128);
}

TEST_CASE("the usual filler is the lowest id that covers", "[veil]") {
  using enum Visibility;
  const std::vector<Visibility> rows = {empty, transparent, empty, opaque, opaque};
  CHECK(veil_filler(VisibilityTable(rows)) == 3);
}

}  // namespace runstone::test
