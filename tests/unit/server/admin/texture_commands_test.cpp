// The command `materials textures`: from a folder to the records of the world.
#include "server/admin/texture_commands.hpp"

#include <catch2/catch.hpp>

#include "tests/support/core/temp_folder.hpp"
#include "tests/support/textures/test_png.hpp"
#include "tests/unit/server/admin/material_command_bench.hpp"

namespace runstone::test {

TEST_CASE("materials textures gives the pictures of a folder, once", "[admin][textures]") {
  MaterialCommandBench bench;
  const TempFolder pictures;
  const std::string name = bench.table()[1].name;
  write_file(pictures / (name + ".png"), plain_png(16, 16, {1, 2, 3, 255}));
  const auto& table = bench.bench.server.order().textures().table();
  const CommandAnswer preview =
      bench.give({}, "materials textures preview \"" + pictures.path() + "\"");
  CHECK(preview.is_ok);
  CHECK(preview.text.starts_with("a folder of pictures: 1 picture for 1 material (6 sides)"));
  CHECK(preview.text.ends_with("nothing is changed by a preview"));
  CHECK(table.empty());
  const CommandAnswer given = bench.give({}, "materials textures \"" + pictures.path() + "\"");
  CHECK(given.is_ok);
  CHECK(given.text.ends_with("given, for ever (record 1)"));
  CHECK(table.number(1, Direction::pos_y) == 1);
  CHECK(bench.give({}, "log cause textures").text.find("textures texture of " + name) !=
        std::string::npos);
  CHECK_FALSE(bench.give({}, "materials textures " + pictures.path() + "/none").is_ok);
  for (const std::string line : {"materials textures", "materials textures preview"}) {
    const CommandAnswer without_folder = bench.give({}, line);
    CHECK_FALSE(without_folder.is_ok);
    CHECK(without_folder.text.ends_with(
        ": one folder of pictures comes after it, in quotes if it has blanks"));
  }
  const PublicKey key = key_pair_of(seed_of(3)).public_key;
  CHECK_FALSE(bench.give({1, {key, true}}, "materials textures " + pictures.path()).is_ok);
}

}  // namespace runstone::test
