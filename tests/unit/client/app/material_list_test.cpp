#include "client/app/material_list.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("the list of materials has a line for each id, in order", "[client_app]") {
  MaterialTable table;
  CHECK(material_list(table) == "0 air\n");
  for (int i = 1; i <= 10; ++i)
    REQUIRE(table.add({"mod:m" + std::to_string(i), {1, 2, 3, 255}, Visibility::opaque, {}})
                .has_value());
  const std::string list = material_list(table);
  CHECK(list.starts_with(" 0 air\n 1 mod:m1\n"));
  CHECK(list.ends_with(" 9 mod:m9\n10 mod:m10\n"));
}
