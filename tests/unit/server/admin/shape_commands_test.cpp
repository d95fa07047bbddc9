// The command `materials shapes`: from the names of materials to their shapes.
#include "server/admin/shape_commands.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/admin/material_command_bench.hpp"

namespace runstone::test {

TEST_CASE("materials shapes gives what names say, once", "[admin][materials][shapes]") {
  MaterialCommandBench bench;
  CHECK(bench.give({}, "materials shapes").text ==
        "every material has the shape that its name says: nothing is changed");
  const auto first = static_cast<Material>(bench.table().size());
  std::vector<MaterialRow> rows;
  for (const char* name : {"minecraft:oak_stairs[facing=east]", "minecraft:stone",
                           "minecraft:oak_slab", "stairs:slab_wood"})
    rows.push_back({name, {1, 2, 3, 255}, Visibility::opaque});
  rows.push_back({"minecraft:poppy", {0, 0, 0, 0}, Visibility::empty});
  REQUIRE(bench.bench.server.changes().add_materials(rows, bench.bench.now()).has_value());
  const CommandAnswer preview = bench.give({}, "materials shapes preview");
  CHECK(preview.is_ok);
  CHECK(preview.text ==
        "3 materials would get a shape, for ever: minecraft:oak_stairs[facing=east], "
        "minecraft:oak_slab, stairs:slab_wood");
  CHECK(bench.table()[first].shape.is_cube());
  const CommandAnswer given = bench.give({}, "materials shapes");
  CHECK(given.is_ok);
  CHECK(given.text ==
        "3 materials got a shape (record 2): minecraft:oak_stairs[facing=east], "
        "minecraft:oak_slab, stairs:slab_wood");
  CHECK_FALSE(bench.table()[first].shape.is_cube());
  CHECK(bench.table()[first + 1].shape.is_cube());
  CHECK(bench.table()[first + 4].shape.is_cube());
  CHECK(bench.give({}, "materials shapes").text.starts_with("every material has"));
  CHECK(bench.give({}, "log cause materials")
            .text.find("materials shapes of minecraft:oak_stairs[facing=east], ") !=
        std::string::npos);
}

TEST_CASE("materials shapes is for the console and control, and takes one word",
          "[admin][materials][shapes]") {
  MaterialCommandBench bench;
  CHECK(bench.give({}, "materials shapes now").text ==
        "materials shapes \"now\": preview comes after it, or nothing");
  const PublicKey key = key_pair_of(seed_of(3)).public_key;
  CHECK_FALSE(bench.give({1, {key, true}}, "materials shapes").is_ok);
}

}  // namespace runstone::test
