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

TEST_CASE("beyond the border a material hides, is one of the chunk's transparent ones, or nothing",
          "[mesh]") {
  const VisibilityTable& v = mesh_visibility();
  rdm::MaterialCodes codes;
  codes.number(kStone, v);
  codes.number(kWater, v);
  CHECK(codes.clear_bits() == 0);
  CHECK(codes.border_code(kStone, v) == 1);
  CHECK(codes.border_code(kDirt, v) == 1);
  CHECK(codes.border_code(kWater, v) == 2);
  CHECK(codes.border_code(kGlass, v) == 0);
  CHECK(codes.border_code(kEmpty, v) == 0);
  codes.number(kGlass, v);
  CHECK(codes.clear_bits() == 1);
  CHECK(codes.border_code(kWater, v) == 4);
  CHECK(codes.border_code(kGlass, v) == (4 | 1 << 1));
  CHECK(codes.border_code(kDirt, v) == 1);
  CHECK(codes.solid_count() == 3);
}

}  // namespace
}  // namespace runstone::test
