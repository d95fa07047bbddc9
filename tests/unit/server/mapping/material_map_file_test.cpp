#include "server/mapping/material_map_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {
namespace {

std::string refusal(std::string_view toml) {
  const auto map = parse_material_map(toml, "map.toml");
  return map ? "" : map.error().message();
}

}  // namespace

TEST_CASE("a file of a map has its rows below [materials]", "[mapping]") {
  const auto map = parse_material_map(
      "# woods\n[materials]\n\"minecraft:oak_planks\" = \"planks\"\n\"default:*\" = 'stone'\n"
      "stone = \"my stone\"\n",
      "map.toml");
  REQUIRE(map.has_value());
  REQUIRE(map->rows().size() == 3);
  CHECK(map->rows()[0].from == "minecraft:oak_planks");
  CHECK(map->rows()[0].to == "planks");
  CHECK(map->rows()[1].from == "default:*");
  CHECK(map->rows()[2].to == "my stone");
}

TEST_CASE("a bad file of a map is refused with its line and its key", "[mapping]") {
  CHECK(refusal("[materials]\n\"a\" = \"b\"\n\"c\" = 4\n") ==
        "map.toml:3: \"c\": must be the name of a material, in quotes");
  CHECK(refusal("[materials]\na = \"b\"\n\n[blocks]\nc = \"d\"\n") ==
        "map.toml:4: \"blocks\": unknown key: rows stand below the line [materials]");
  CHECK(refusal("\"a\" = \"b\"\n").starts_with("map.toml:1: \"a\": unknown key"));
  CHECK(refusal("[materials]\na = \"" + std::string(65, 'x') + "\"\n") ==
        "map.toml:2: \"a\": must be a name of at most 64 bytes");
  CHECK(refusal("[materials]\nb = \"x\"\n\"a*b\" = \"c\"\n")
            .starts_with("map.toml:3: \"a*b\": has a * before its end"));
  CHECK(refusal("[materials]\na.b = \"c\"\n").starts_with("map.toml:2: \"a\": must be the name"));
  CHECK(refusal("[materials]\na = \"b\"\na = \"c\"\n").starts_with("map.toml:3: "));
  CHECK(refusal("[materials]\n").starts_with("map.toml:1: has no rows"));
  CHECK(refusal("").starts_with("map.toml: has no rows"));
  CHECK(refusal("materials = 4\n").starts_with("map.toml:1: has no rows"));
  CHECK(refusal("[materials\n").starts_with("map.toml:1: "));
  const std::string long_key(600, 'k');
  CHECK(refusal("[materials]\n" + long_key + " = \"b\"\n") ==
        "map.toml:2: \"" + long_key.substr(0, 80) + "...\": is longer than 512 bytes");
}

TEST_CASE("a file of a map that is large, missing or a pipe is refused in one line", "[mapping]") {
  const TempFolder folder;
  const auto refused = [&](const std::string& name) {
    const auto map = read_material_map(folder / name);
    REQUIRE_FALSE(map.has_value());
    CHECK(map.error().starts_with(folder / name));
    CHECK(map.error().find('\n') == std::string::npos);
  };
  refused("none.toml");
  std::ofstream(folder / "large.toml") << std::string(kMaterialMapFileBytesMax + 1, '#');
  refused("large.toml");
  REQUIRE(::mkfifo((folder / "pipe.toml").c_str(), 0600) == 0);
  refused("pipe.toml");
  std::ofstream(folder / "good.toml") << "[materials]\n\"a\" = \"b\"\n\"c\" = \"d\"\n";
  const auto map = read_material_map(folder / "good.toml");
  REQUIRE(map.has_value());
  CHECK(unused_rows_notice("good.toml", *map, {1}) ==
        "good.toml: these rows fit no material: \"a\"");
  CHECK(unused_rows_notice("good.toml", *map, {0, 1}).empty());
}

}  // namespace runstone::test
