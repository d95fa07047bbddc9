#include "common/mesh/rdm/chunk_palette.hpp"

#include <catch2/catch.hpp>

#include "tests/support/mesh_scene.hpp"

namespace runstone::test {
namespace {

TEST_CASE("materials are numbered in the order they come, a class apart", "[mesh]") {
  const VisibilityTable& v = mesh_visibility();
  rdm::ChunkPalette codes;
  for (int round = 0; round < 2; ++round) {  // clear() forgets everything
    CHECK(codes.solid_count() == 0);
    CHECK(codes.number(kDirt, v) == 1);
    CHECK(codes.number(kEmpty, v) == 0);
    CHECK(codes.number(kBarrier, v) == 0);
    CHECK_FALSE(codes.has_transparent());
    CHECK(codes.single() == kDirt);
    CHECK(codes.number(kWater, v) == rdm::kTransparentBit);
    CHECK(codes.has_transparent());
    CHECK(codes.number(kStone, v) == 2);
    CHECK(codes.number(65535, v) == 3);
    CHECK(codes.number(kDirt, v) == 1);
    CHECK(codes.solid_count() == 4);
    CHECK(codes.transparent_count() == 1);
    CHECK(codes.transparent_code(kWater) == rdm::kTransparentBit);
    CHECK(codes.transparent_code(kDirt) == 0);
    CHECK(codes.transparent_code(kGlass) == 0);
    for (const Material material : {kDirt, kStone, Material{65535}, kWater}) {
      const rdm::PaletteIndex code = codes.number(material, v);
      CHECK(codes.material(code) == material);
      const auto byte = rdm::code_as<rdm::BytePaletteIndex>(code);
      CHECK(codes.material(byte) == material);
      CHECK(rdm::whole_code(byte) == code);
    }
    codes.clear();
  }
}

TEST_CASE("codes fit bytes up to 127 opaque and 128 transparent materials", "[mesh]") {
  const VisibilityTable v(visibilities(many_materials()));  // 1 to 149 opaque, 150 to 299 transparent
  rdm::ChunkPalette codes;
  for (Material material = 1; material <= 127; ++material) codes.number(material, v);
  for (Material material = 150; material < 278; ++material) codes.number(material, v);
  CHECK(codes.fit_bytes());
  for (const Material material : {Material{127}, Material{277}}) {
    CHECK(codes.material(rdm::code_as<rdm::BytePaletteIndex>(codes.number(material, v))) ==
          material);
  }
  SECTION("one opaque material more") { codes.number(128, v); }
  SECTION("one transparent material more") { codes.number(278, v); }
  CHECK_FALSE(codes.fit_bytes());
  CHECK(codes.material(codes.number(277, v)) == 277);
}

}  // namespace
}  // namespace runstone::test
