// A table of materials by their names, for tests of the hands.
#pragma once
#include <catch2/catch.hpp>
#include <initializer_list>
#include <string>
#include <string_view>

#include "common/formats/shape_names.hpp"
#include "common/materials/material_table.hpp"

namespace runstone::test {

/// Returns a table with these names, from id 1 on, with the shapes that belong to them.
inline MaterialTable hands_table(std::initializer_list<const char*> names) {
  MaterialTable out;
  for (const char* name : names) {
    MaterialInfo info;
    info.name = name;
    info.shape = shape_of_material_name(name).value_or(Shape{});
    REQUIRE(out.add(std::move(info)));
  }
  return out;
}

inline Material id_in(const MaterialTable& table, std::string_view name) {
  const auto id = table.find(name);
  INFO(std::string(name));
  REQUIRE(id);
  return *id;
}

}  // namespace runstone::test
