#include "common/core/material_look.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("a look is valid up to 100 percent and up to the last pattern", "[core]") {
  CHECK(validate_look({}).has_value());
  CHECK(validate_look({100, 100, 100, 100, MaterialPattern::weave}).has_value());
  CHECK(validate_look({0, 0, 0, 0, MaterialPattern::none}).has_value());
  CHECK_FALSE(validate_look({101, 0, 0, 0}).has_value());
  CHECK_FALSE(validate_look({0, 101, 0, 0}).has_value());
  CHECK_FALSE(validate_look({0, 0, 101, 0}).has_value());
  CHECK_FALSE(validate_look({0, 0, 0, 101}).has_value());
  CHECK_FALSE(
      validate_look({0, 0, 0, 0, static_cast<MaterialPattern>(kMaterialPatterns)}).has_value());
}

TEST_CASE("the nearest valid look cuts shares off and has no unknown pattern", "[core]") {
  const MaterialLook valid{1, 2, 3, 100, MaterialPattern::bark};
  CHECK(nearest_valid_look(valid) == valid);
  const MaterialLook silly{255, 101, 200, 128, static_cast<MaterialPattern>(255)};
  CHECK(nearest_valid_look(silly) == MaterialLook{100, 100, 100, 100, MaterialPattern::none});
  CHECK(validate_look(nearest_valid_look(silly)).has_value());
}
