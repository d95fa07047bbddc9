#include "server/admin/material_list.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace runstone;

TEST_CASE("materials lists the names in the order of their ids", "[admin]") {
  MaterialTable table;
  for (const char* name : {"default:stone", "default:brick", "wool:red"}) {
    REQUIRE(table.add({name, {1, 2, 3, 255}, Visibility::opaque, std::nullopt}).has_value());
  }
  CHECK(material_list(table, "") == "air\ndefault:stone\ndefault:brick\nwool:red");
  CHECK(material_list(table, "default") == "default:stone\ndefault:brick");
  CHECK(material_list(table, "gold") == "no material's name contains \"gold\"");
}

TEST_CASE("materials lists 1000 names and counts the others", "[admin]") {
  MaterialTable table;
  for (int i = 1; i < 1002; ++i) {
    REQUIRE(table.add({"m" + std::to_string(i), {1, 2, 3, 255}, Visibility::opaque, std::nullopt})
                .has_value());
  }
  const std::string text = material_list(table, "");
  CHECK(text.find("\nm999\nand 2 more: materials PART") != std::string::npos);
  CHECK(text.find("\nm1000\n") == std::string::npos);
}
