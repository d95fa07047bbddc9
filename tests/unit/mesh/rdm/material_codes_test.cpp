#include "common/mesh/rdm/material_codes.hpp"

#include <catch2/catch.hpp>

#include "tests/support/mesh_scene.hpp"

namespace runstone::test {
namespace {

TEST_CASE("materials are numbered in the order they come, a class apart", "[mesh]") {
  const VisibilityTable& v = mesh_visibility();
  rdm::MaterialCodes codes;
  for (int round = 0; round < 2; ++round) {  // clear() forgets everything
    CHECK(codes.solid_count() == 0);
    CHECK(codes.number(kDirt, v) == rdm::kOpaqueBit);
    CHECK(codes.number(kEmpty, v) == 0);
    CHECK(codes.number(kBarrier, v) == 0);
    CHECK(codes.number_bits() == 0);
    CHECK_FALSE(codes.has_transparent());
    CHECK(codes.number(kWater, v) == rdm::kTransparentBit);
    CHECK(codes.has_transparent());
    CHECK(codes.number_bits() == 0);
    CHECK(codes.number(kStone, v) == (rdm::kOpaqueBit | 1u << 1));
    CHECK(codes.number(65535, v) == (rdm::kOpaqueBit | 2u << 1));
    CHECK(codes.number(kDirt, v) == rdm::kOpaqueBit);
    CHECK(codes.number_bits() == 2);
    CHECK(codes.solid_count() == 4);
    CHECK(codes.material(false, 0) == kDirt);
    CHECK(codes.material(false, 2) == 65535);
    CHECK(codes.material(true, 0) == kWater);
    codes.clear();
  }
}

TEST_CASE("a material the chunk lacks is opaque or nothing", "[mesh]") {
  const VisibilityTable& v = mesh_visibility();
  rdm::MaterialCodes codes;
  codes.number(kStone, v);
  codes.number(kWater, v);
  CHECK(codes.code(kStone, v) == rdm::kOpaqueBit);
  CHECK(codes.code(kDirt, v) == rdm::kOpaqueBit);
  CHECK(codes.code(kWater, v) == rdm::kTransparentBit);
  CHECK(codes.code(kGlass, v) == 0);
  CHECK(codes.code(kEmpty, v) == 0);
  CHECK(codes.solid_count() == 2);
}

}  // namespace
}  // namespace runstone::test
