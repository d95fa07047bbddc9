#include "common/mesh/rdm/chunk_palette.hpp"

#include <catch2/catch.hpp>

#include "tests/support/mesh_scene.hpp"

namespace runstone::test {
namespace {

TEST_CASE("materials get indices in the order in which they occur, counted per class", "[mesh]") {
  const VisibilityTable& v = mesh_visibility();
  rdm::ChunkPalette palette;
  for (int round = 0; round < 2; ++round) {  // clear() forgets everything
    CHECK(palette.solid_count() == 0);
    CHECK(palette.index_of(kDirt, v) == 1);
    CHECK(palette.index_of(kEmpty, v) == 0);
    CHECK(palette.index_of(kBarrier, v) == 0);
    CHECK_FALSE(palette.has_transparent());
    CHECK(palette.single() == kDirt);
    CHECK(palette.index_of(kWater, v) == rdm::kTransparentBit);
    CHECK(palette.has_transparent());
    CHECK(palette.index_of(kStone, v) == 2);
    CHECK(palette.index_of(65535, v) == 3);
    CHECK(palette.index_of(kDirt, v) == 1);
    CHECK(palette.solid_count() == 4);
    CHECK(palette.transparent_count() == 1);
    CHECK(palette.transparent_index(kWater) == rdm::kTransparentBit);
    CHECK(palette.transparent_index(kDirt) == 0);
    CHECK(palette.transparent_index(kGlass) == 0);
    for (const Material material : {kDirt, kStone, Material{65535}, kWater}) {
      const rdm::PaletteIndex index = palette.index_of(material, v);
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
  for (Material material = 1; material <= 127; ++material) palette.index_of(material, v);
  for (Material material = 150; material < 278; ++material) palette.index_of(material, v);
  CHECK(palette.fit_bytes());
  for (const Material material : {Material{127}, Material{277}}) {
    CHECK(palette.material(rdm::index_as<rdm::BytePaletteIndex>(palette.index_of(material, v))) ==
          material);
  }
  SECTION("one opaque material more") { palette.index_of(128, v); }
  SECTION("one transparent material more") { palette.index_of(278, v); }
  CHECK_FALSE(palette.fit_bytes());
  CHECK(palette.material(palette.index_of(277, v)) == 277);
}

}  // namespace
}  // namespace runstone::test
