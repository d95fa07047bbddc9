#include "common/materials/veil_visibility.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace runstone::test {
namespace {

MaterialInfo opaque_with_body(const std::string& name, MaterialBody body) {
  MaterialInfo info;
  info.name = name;
  info.colour = {1, 2, 3, 255};
  info.body = body;
  return info;
}

}  // namespace

TEST_CASE("nothing hides behind an opaque material that a body or light enters, or behind a shape",
          "[materials]") {
  MaterialTable table;
  REQUIRE(table.add(opaque_with_body("lava", MaterialBody::liquid)));
  REQUIRE(table.add(opaque_with_body("smoke", MaterialBody::passable)));
  REQUIRE(table.add(opaque_with_body("stone", MaterialBody::solid)));
  MaterialInfo slab = opaque_with_body("slab", MaterialBody::solid);
  slab.shape = {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  REQUIRE(table.add(slab));
  REQUIRE(table.add(opaque_with_body("oak_leaves", MaterialBody::solid)));
  using enum Visibility;
  CHECK(cube_visibilities(table) ==
        std::vector<Visibility>{empty, opaque, opaque, opaque, empty, opaque});
  CHECK(veil_visibilities(table) ==
        std::vector<Visibility>{empty, transparent, transparent, opaque, empty, transparent});
}

}  // namespace runstone::test
