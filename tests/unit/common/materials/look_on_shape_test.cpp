#include "common/materials/look_on_shape.hpp"

#include <catch2/catch.hpp>
#include <string_view>

#include "common/materials/default_look.hpp"

namespace runstone::test::look_on_shape_test {
namespace {

const Shape kCross{ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};
const Shape kHalf{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};

MaterialLook with(MaterialPattern pattern) { return {1, 2, 3, 4, pattern}; }

}  // namespace

TEST_CASE("the patterns of plants are for crossed planes alone, and all others for every shape",
          "[materials]") {
  for (int i = 0; i < kMaterialPatterns; ++i) {
    CAPTURE(i);
    const auto pattern = static_cast<MaterialPattern>(i);
    const bool is_of_plants = i >= 7;  // values are frozen
    CHECK(is_silhouette(pattern) == is_of_plants);
    CHECK(look_on_shape(with(pattern), kCross) == with(pattern));
    for (const Shape& shape : {Shape{}, kHalf}) {
      CHECK(look_on_shape(with(pattern), shape) ==
            with(is_of_plants ? MaterialPattern::none : pattern));
    }
  }
}

TEST_CASE("the look by a name has a pattern of plants if the shape is theirs", "[materials]") {
  for (const std::string_view name :
       {"default:grass_3", "minecraft:poppy", "default:bush_sapling", "grass", "reeds"}) {
    CAPTURE(name);
    const MaterialLook plant = default_look(name, MaterialBody::passable, kCross);
    CHECK(is_silhouette(plant.pattern));
    for (const Shape& shape : {Shape{}, kHalf}) {
      MaterialLook plain = plant;
      plain.pattern = MaterialPattern::none;
      CHECK(default_look(name, MaterialBody::solid, shape) == plain);
    }
  }
  MaterialInfo row;
  row.name = "grass";
  CHECK_FALSE(is_silhouette(look_of(row).pattern));
  row.shape = kCross;
  CHECK(is_silhouette(look_of(row).pattern));
}

TEST_CASE("a table keeps all but the patterns of plants on cubes", "[materials]") {
  MaterialTable table = landscape_material_table();
  CHECK(has_silhouettes(table));
  CHECK(with_looks_on_shapes(table) == table);
  CHECK_FALSE(has_silhouettes(default_material_table()));
  MaterialInfo moss{"moss", {1, 2, 3, 255}, Visibility::opaque, std::nullopt};
  moss.look = with(MaterialPattern::blades);
  const auto id = table.add(moss);
  REQUIRE(id.has_value());
  const MaterialTable plain = with_looks_on_shapes(table);
  REQUIRE(plain.size() == table.size());
  CHECK(plain[*id].look == with(MaterialPattern::none));
  CHECK(plain[static_cast<Material>(*id - 1U)] == table[static_cast<Material>(*id - 1U)]);
}

}  // namespace runstone::test::look_on_shape_test
