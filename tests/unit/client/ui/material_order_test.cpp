#include "client/ui/material_order.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {

TEST_CASE("materials are sorted by name, and by colour from greys over the circle of hues",
          "[client_ui]") {
  MaterialTable table;
  const auto add = [&](const char* name, MaterialColour colour) {
    const auto id = table.add({name, colour, Visibility::opaque, {}, MaterialBody::solid});
    REQUIRE(id.has_value());
    return *id;
  };
  const Material pink = add("pink", {220, 60, 120, 255});
  const Material dark_blue = add("zinc", {10, 20, 120, 255});
  const Material blue = add("blue", {20, 40, 240, 255});
  const Material white = add("white", {250, 250, 245, 255});
  const Material green = add("green", {30, 200, 30, 255});
  const Material red = add("red", {200, 20, 15, 255});
  const Material black = add("black", {12, 12, 12, 255});
  const Material twin = add("a_twin", {12, 12, 12, 255});
  const std::vector<Material> all = {pink, dark_blue, blue, white, green, red, black, twin};
  std::vector<Material> sorted = all;
  sort_materials(sorted, table, MaterialOrder::table);
  CHECK(sorted == all);
  sort_materials(sorted, table, MaterialOrder::colour);
  CHECK(sorted == std::vector<Material>{black, twin, white, red, green, dark_blue, blue, pink});
  sort_materials(sorted, table, MaterialOrder::name);
  CHECK(sorted == std::vector<Material>{twin, black, blue, green, pink, red, white, dark_blue});
}

}  // namespace runstone::test
