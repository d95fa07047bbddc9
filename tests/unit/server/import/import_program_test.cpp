#include "server/import/import_program.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/materials/material_lookup.hpp"
#include "server/import/import_luanti.hpp"
#include "server/store/store.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/unit/server/import/luanti_map_file.hpp"

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
  request.source = folder.path();
  request.world = folder / "world";
  std::ostringstream out;
  const auto imported = import_world(request, out);
  REQUIRE_FALSE(imported.has_value());
  CHECK(imported.error().find("each of its 384 blocks is damaged, the first at pos ") !=
        std::string::npos);
  CHECK_FALSE(std::filesystem::exists(request.world));
}

TEST_CASE("an imported world has the builders' palette, unless the request says none",
          "[server][import]") {
  const TempFolder folder;
  ImportRequest request;
  request.source = std::string(RUNSTONE_SOURCE_DIR) + "/tests/data/luanti_v7_small";
  request.world = folder / "world";
  request.palette = GENERATE(true, false);
  std::ostringstream out;
  const auto imported = import_world(request, out);
  INFO((imported ? "" : imported.error()));
  REQUIRE(imported.has_value());
  LuantiImportSink sink;
  sink.materials = [](const MaterialTable&) {};
  sink.chunk = [](const ChunkKey&, RunChunk&&) { return true; };
  const auto source = import_luanti(request.source, {}, sink);
  REQUIRE(source.has_value());
  const auto store = open_world(request.world, StoreAccess::read_only);
  REQUIRE(store.has_value());
  const MaterialTable& materials = (*store)->meta().materials;
  REQUIRE(materials.size() >= source->materials.size());
  for (std::size_t id = 0; id < source->materials.size(); ++id)
    CHECK(materials.rows()[id] == source->materials.rows()[id]);  // with their looks
  if (!request.palette) {
    CHECK(materials.size() == source->materials.size());
    CHECK(out.str().find("the builders' palette adds 0, ") != std::string::npos);
    return;
  }
  for (const MaterialInfo& info : default_material_table().rows()) {
    CAPTURE(info.name);
    CHECK(find_material(materials, info.name).has_value());
  }
}

TEST_CASE("an import of nothing but air fails and makes no world", "[server][import]") {
  const TempFolder folder;
  LuantiBlockFields air = stone_block();
  air.names[0].second = GENERATE(as<std::string>{}, "air", "butterflies:butterfly_red");
  std::filesystem::create_directory(folder / "luanti");
  write_luanti_map(folder / "luanti/map.sqlite", {{{0, 0, 0}, luanti_row(air)}});
  ImportRequest request;
  request.source = folder / "luanti";
  request.world = folder / "world";
  std::ostringstream out;
  const auto imported = import_world(request, out);
  REQUIRE_FALSE(imported.has_value());
  CHECK(imported.error().find("nothing but air is in its 1 blocks") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(request.world));
}

TEST_CASE("the report of an import names versions, repeated rows and the second map",
          "[server][import]") {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "luanti");
  write_luanti_map(folder / "luanti/map.sqlite",
                   {{{0, 0, 0}, luanti_row(stone_block())},
                    {{0, 0, 0}, luanti_row(stone_block())},
                    {{1, 0, 0}, Bytes{22, 0}}},
                   "CREATE TABLE blocks (pos INT, data BLOB)");
  std::ofstream(folder / "luanti/world.mt") << "readonly_backend = sqlite3\n";
  ImportRequest request;
  request.source = folder / "luanti";
  request.world = folder / "world";
  std::ostringstream out;
  REQUIRE(import_world(request, out).has_value());
  CAPTURE(out.str());
  CHECK(out.str().find("damaged block 1,0,0 (pos 1, version 22)") != std::string::npos);
  CHECK(out.str().find("--recompress") != std::string::npos);
  CHECK(out.str().find("1 rows have the position of an earlier row") != std::string::npos);
  CHECK(out.str().find("readonly_backend") != std::string::npos);
}

TEST_CASE("a Luanti world is imported with the materials that a map chooses", "[server][import]") {
  const TempFolder folder;
  ImportRequest request;
  request.source = std::string(RUNSTONE_SOURCE_DIR) + "/tests/data/luanti_v7_small";
  request.world = folder / "world";
  request.palette = false;
  request.map = folder / "map.toml";
  std::ofstream(request.map) << "[materials]\n\"default:*\" = \"stone\"\n\"none:*\" = \"sand\"\n"
                                "\"default:water_source\" = \"air\"\n";
  std::ostringstream out;
  const auto imported = import_world(request, out);
  INFO((imported ? out.str() : imported.error()));
  REQUIRE(imported.has_value());
  CHECK(out.str().find("these rows fit no material: \"none:*\"") != std::string::npos);
  const auto store = open_world(request.world, StoreAccess::read_only);
  REQUIRE(store.has_value());
  const MaterialTable& materials = (*store)->meta().materials;
  CHECK(materials.find("stone").has_value());
  for (const MaterialInfo& info : materials.rows()) CHECK_FALSE(info.name.starts_with("default:"));
}
