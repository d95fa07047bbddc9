#include "server/import/import_program.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <sstream>

#include "tests/support/raw_sql.hpp"
#include "tests/support/temp_folder.hpp"

using namespace runstone;
using namespace runstone::test;

TEST_CASE("an import of which every block is damaged fails and makes no world",
          "[server][import]") {
  const TempFolder folder;
  const std::string map = folder / "map.sqlite";
  std::filesystem::copy_file(
      std::string(RUNSTONE_SOURCE_DIR) + "/tests/data/luanti_v7_small/map.sqlite", map);
  std::filesystem::permissions(map, std::filesystem::perms::owner_all);
  raw_sql(map, "UPDATE blocks SET data = x'00'");
  ImportRequest request;
  request.luanti = folder.path();
  request.world = folder / "world";
  std::ostringstream out;
  const auto imported = import_world(request, out);
  REQUIRE_FALSE(imported.has_value());
  CHECK(imported.error().find("each of its 384 blocks is damaged, the first at pos ") !=
        std::string::npos);
  CHECK_FALSE(std::filesystem::exists(request.world));
}
