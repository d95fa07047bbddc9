#include "common/materials/material_lookup.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace runstone;

namespace {

MaterialTable table_of(const std::vector<std::string>& names) {
  MaterialTable table;
  for (const std::string& name : names) {
    REQUIRE(table.add({name, {1, 2, 3, 255}, Visibility::opaque, std::nullopt}).has_value());
  }
  return table;
}

}  // namespace

TEST_CASE("a material is found by its full name", "[materials]") {
  const MaterialTable table = table_of({"default:stone", "stone", "mod:sub:stone"});
  CHECK(find_material(table, "default:stone").value() == 1);
  CHECK(find_material(table, "stone").value() == 2);  // the full name wins over the part
  CHECK(find_material(table, "air").value() == kEmpty);
}

TEST_CASE("a material is found by the part after a colon if no other material has it",
          "[materials]") {
  const MaterialTable table = table_of({"default:stone", "default:stonebrick", "mod:sub:clay"});
  CHECK(find_material(table, "stone").value() == 1);
  CHECK(find_material(table, "clay").value() == 3);
  CHECK(find_material(table, "sub:clay").value() == 3);
}

TEST_CASE("a name that no material has is an error", "[materials]") {
  const MaterialTable table = table_of({"default:stone"});
  for (const std::string name : {"tone", "default", "", ":stone", "Stone", "default:"}) {
    CAPTURE(name);
    const auto found = find_material(table, name);
    REQUIRE_FALSE(found.has_value());
    CHECK(found.error() == "the world has no material \"" + name + "\"");
  }
}

TEST_CASE("the error for an ambiguous name lists the candidates", "[materials]") {
  const auto two = find_material(table_of({"a:stone", "b:stone"}), "stone");
  REQUIRE_FALSE(two.has_value());
  CHECK(two.error() == "\"stone\" is ambiguous: a:stone, b:stone");

  std::vector<std::string> names;
  for (char c = 'a'; c < 'k'; ++c) names.push_back(std::string(1, c) + ":stone");
  const auto many = find_material(table_of(names), "stone");
  REQUIRE_FALSE(many.has_value());
  CHECK(many.error() ==
        "\"stone\" is ambiguous: a:stone, b:stone, c:stone, d:stone, e:stone, f:stone, g:stone, "
        "h:stone, …");
}
