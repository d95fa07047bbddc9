#include <catch2/catch.hpp>

#include "client/body/body_materials.hpp"
#include "common/mesh_materials/mesh_materials_of.hpp"

namespace runstone::test {

TEST_CASE("what meshers read of the materials makes one table of shapes, which bodies share",
          "[render][shapes]") {
  MaterialTable table;
  MaterialInfo slab{"slab", {9, 9, 9, 255}, Visibility::opaque, {}};
  slab.shape.boxes = {{{0, 0, 0}, {16, 8, 16}}};
  MaterialInfo carpet{"carpet", {9, 9, 9, 255}, Visibility::transparent, {}};
  carpet.shape.boxes = {{{0, 0, 0}, {16, 1, 16}}};
  REQUIRE(table.add(slab).has_value());
  REQUIRE(table.add(carpet).has_value());
  const std::uint64_t before = ShapeTable(shapes_of(table)).serial();
  const MeshMaterialsPtr meshed = mesh_materials_of(table);
  CHECK(meshed->shapes.serial() == before + 1);
  CHECK(meshed->cubes[1] == Visibility::empty);
  CHECK(meshed->rows[2] == Visibility::transparent);
  CHECK(meshed->tiles[1] == Visibility::opaque);
  CHECK(meshed->tiles[2] == Visibility::empty);
  const BodyMaterials body = body_materials(table, shapes_in(meshed));
  CHECK(&body.solid.table() == &meshed->shapes);
  CHECK(ShapeTable(shapes_of(table)).serial() == before + 2);
}

}  // namespace runstone::test
