#include "common/mesh/rdm/chunk_palette.hpp"

#include <catch2/catch.hpp>
#include <span>

#include "common/runs/run_list.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {
namespace {

/// Lists one run of the material.
rdm::PaletteIndex index_of(rdm::ChunkPalette& palette, Material material,
                           const VisibilityTable& visibility) {
  const PackedRun run{1, material};
  rdm::PaletteIndex index = 0;
  palette.list(NarrowRuns(std::span(&run, 1)), 0, 1, visibility, &index);
  return index;
}

TEST_CASE("materials get indices in the order in which they occur, counted per class", "[mesh]") {
  const VisibilityTable& v = mesh_visibility();
  rdm::ChunkPalette palette;
  for (int round = 0; round < 2; ++round) {  // clear() forgets everything
    CHECK(palette.solid_count() == 0);
    CHECK(index_of(palette, kDirt, v) == 1);
    CHECK(index_of(palette, kEmpty, v) == 0);
    CHECK(index_of(palette, kBarrier, v) == 0);
    CHECK_FALSE(palette.has_transparent());
    CHECK(palette.single() == kDirt);
    CHECK(index_of(palette, kWater, v) == rdm::kTransparentBit);
    CHECK(palette.has_transparent());
    CHECK(index_of(palette, kStone, v) == 2);
    CHECK(index_of(palette, 65535, v) == 3);
    CHECK(index_of(palette, kDirt, v) == 1);
    CHECK(palette.solid_count() == 4);
    CHECK(palette.transparent_count() == 1);
    CHECK(palette.transparent_index(kWater) == rdm::kTransparentBit);
    CHECK(palette.transparent_index(kDirt) == 0);
    CHECK(palette.transparent_index(kGlass) == 0);
    for (const Material material : {kDirt, kStone, Material{65535}, kWater}) {
      const rdm::PaletteIndex index = index_of(palette, material, v);
      CHECK(palette.material(index) == material);
      const auto byte = rdm::index_as<rdm::BytePaletteIndex>(index);
      CHECK(palette.material(byte) == material);
      CHECK(rdm::full_index(byte) == index);
    }
    palette.clear();
  }
}

TEST_CASE("palette indices fit bytes up to 127 opaque and 128 transparent materials", "[mesh]") {
  const VisibilityTable v(
      visibilities(many_materials()));  // 1 to 149 opaque, 150 to 299 transparent
  rdm::ChunkPalette palette;
  for (Material material = 1; material <= 127; ++material) index_of(palette, material, v);
  for (Material material = 150; material < 278; ++material) index_of(palette, material, v);
  CHECK(palette.fit_bytes());
  for (const Material material : {Material{127}, Material{277}}) {
    CHECK(palette.material(rdm::index_as<rdm::BytePaletteIndex>(index_of(palette, material, v))) ==
          material);
  }
  SECTION("one opaque material more") { index_of(palette, 128, v); }
  SECTION("one transparent material more") { index_of(palette, 278, v); }
  CHECK_FALSE(palette.fit_bytes());
  CHECK(palette.material(index_of(palette, 277, v)) == 277);
}

}  // namespace
}  // namespace runstone::test
