#include "client/play/named_hotbars.hpp"

#include <catch2/catch.hpp>

#include "client/play/recent_materials.hpp"

namespace runstone::test {

TEST_CASE("a hotbar is kept under a name, and taken in a world with other numbers",
          "[client_app]") {
  const MaterialTable& table = default_material_table();
  NamedHotbars hotbars;
  const NamedHotbars::Slots slots{1, 2, 3, kEmpty, 4};
  CHECK_FALSE(hotbars.take_changed());
  REQUIRE(hotbars.keep("walls", slots, table));
  CHECK(hotbars.take_changed());
  CHECK(*hotbars.take("walls", table) == slots);
  MaterialTable other;
  const auto id =
      other.add({table[3].name, {90, 90, 90, 255}, Visibility::opaque, {}, MaterialBody::solid});
  REQUIRE(id.has_value());
  CHECK(*hotbars.take("walls", other) == NamedHotbars::Slots{kEmpty, kEmpty, *id});
  CHECK(hotbars.take("roofs", table).error() == "no hotbar has the name \"roofs\"");
  REQUIRE(hotbars.forget("walls"));
  CHECK(hotbars.take_changed());
  CHECK_FALSE(hotbars.forget("walls"));
  CHECK_FALSE(hotbars.take_changed());
}

TEST_CASE("names of hotbars are short texts, and their number is bounded", "[client_app]") {
  const MaterialTable& table = default_material_table();
  NamedHotbars hotbars;
  for (const std::string& name : {std::string(), std::string(33, 'x'), std::string("a\nb")})
    CHECK_FALSE(hotbars.keep(name, {}, table));
  for (std::size_t i = 0; i < NamedHotbars::kCountMax; ++i)
    REQUIRE(hotbars.keep(std::to_string(i), {}, table));
  CHECK_FALSE(hotbars.keep("one more", {}, table));
  CHECK(hotbars.keep("0", {1}, table));  // in place of the one of this name
  CHECK(hotbars.lists().size() == NamedHotbars::kCountMax);
}

TEST_CASE("the materials that were used last come first, each once", "[client_app]") {
  RecentMaterials recent;
  for (const Material material : {Material{3}, Material{4}, kEmpty, Material{3}})
    recent.note(material);
  CHECK(recent.all() == std::vector<Material>{3, 4});
  for (Material material = 10; material < 40; ++material) recent.note(material);
  CHECK(recent.all().size() == RecentMaterials::kKeptMax);
  CHECK(recent.all().front() == 39);
}

}  // namespace runstone::test
