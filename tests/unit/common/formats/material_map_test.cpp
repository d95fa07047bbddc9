#include "common/formats/material_map.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/formats/mapped_build.hpp"
#include "common/formats/shape_names.hpp"
#include "common/materials/material_table.hpp"
#include "tests/support/formats/file_builds.hpp"

namespace runstone::test {
namespace {

MaterialMap map_of(std::vector<MaterialMapRow> rows) {
  auto map = MaterialMap::of(std::move(rows));
  REQUIRE(map.has_value());
  return *std::move(map);
}

BuildMaterial grey(const std::string& name, const std::string& states = "") {
  return file_material(name, states, {90, 90, 90, 255});
}

/// Returns the name that a material becomes, or "-" if it stays.
std::string mapped(const MaterialMap& map, const BuildMaterial& material) {
  AppliedRows applied;
  const auto row = map.apply(material, applied);
  CHECK(applied.size() == (row ? 1 : 0));
  return row ? row->name : "-";
}

}  // namespace

TEST_CASE("an exact name counts before a beginning, and of beginnings the longest", "[formats]") {
  const MaterialMap map = map_of({{"*", "sand"},
                                  {"default:*", "stone"},
                                  {"default:dirt*", "dirt"},
                                  {"default:dirt_with_grass", "grass"}});
  CHECK(mapped(map, grey("default:dirt_with_grass")) == "grass");
  CHECK(mapped(map, grey("default:dirt_with_snow")) == "dirt");
  CHECK(mapped(map, grey("default:dirt")) == "dirt");
  CHECK(mapped(map, grey("default:cobble")) == "stone");
  CHECK(mapped(map, grey("farming:soil")) == "sand");
  CHECK(mapped(map, grey("default:dirt_with_grass", "param2=3")) == "grass");
}

TEST_CASE("a name without states is that of all its states, unless a row has them", "[formats]") {
  const MaterialMap map = map_of({{"minecraft:oak_stairs", "planks"},
                                  {"minecraft:oak_stairs[facing=east]", "sand"},
                                  {"default:stair[param2=3]", "stone"}});
  CHECK(mapped(map, grey("minecraft:oak_stairs")) == "planks");
  CHECK(mapped(map, grey("minecraft:oak_stairs[facing=south]")) == "planks");
  CHECK(mapped(map, grey("minecraft:oak_stairs[facing=east]")) == "sand");
  CHECK(mapped(map, grey("default:stair", "param2=3")) == "stone");
  CHECK(mapped(map, grey("default:stair[param2=3]")) == "stone");
  CHECK(mapped(map, grey("default:stair", "param2=4")) == "-");
  // All states, also those that the name leaves out because they are the default.
  const MaterialMap full = map_of(
      {{"minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]", "sand"},
       {"minecraft:oak_stairs[facing=west*", "dirt"}});
  CHECK(mapped(full, grey("minecraft:oak_stairs[facing=east]")) == "sand");
  CHECK(mapped(full, grey("minecraft:oak_stairs[facing=west,half=top]")) == "dirt");
  CHECK(mapped(full, grey("minecraft:oak_stairs[facing=south]")) == "-");
}

TEST_CASE("a mapped material looks as its new name says, and air is empty", "[formats]") {
  const MaterialMap map = map_of({{"a:stone", "stone"},
                                  {"a:gold", "minecraft:gold_block"},
                                  {"a:wall", "my wall"},
                                  {"a:water", "air"},
                                  {"air", "stone"}});
  AppliedRows applied;
  const MaterialTable& built_in = default_material_table();
  CHECK(map.apply(grey("a:stone"), applied) == row_of(built_in[*built_in.find("stone")]));
  const auto gold = map.apply(grey("a:gold"), applied);
  REQUIRE(gold.has_value());
  CHECK(gold->name == "minecraft:gold_block");
  CHECK(gold->colour != grey("").row.colour);
  const auto wall = map.apply(grey("a:wall"), applied);
  REQUIRE(wall.has_value());
  CHECK(wall->name == "my wall");
  CHECK(wall->colour == grey("").row.colour);
  const auto water = map.apply(grey("a:water"), applied);
  REQUIRE(water.has_value());
  CHECK(water->visibility == Visibility::empty);
  CHECK(applied == AppliedRows{0, 1, 2, 3});
  // Voxels that are empty stay empty.
  CHECK_FALSE(map.apply(file_material("air", "", {0, 0, 0, 0}), applied).has_value());
  CHECK(unused_rows_text(map, applied) == "\"air\"");
}

TEST_CASE("a mapped material has the shape of its new name, not that of the source",
          "[formats][shapes]") {
  BuildMaterial stairs = grey("minecraft:oak_stairs");
  stairs.row.shape = *shape_of_material_name("minecraft:oak_stairs");
  const auto mapped_to = [&](const std::string& name) {
    AppliedRows applied;
    return map_of({{"minecraft:oak_stairs", name}}).apply(stairs, applied)->shape;
  };
  CHECK(mapped_to("default:wood").is_cube());
  CHECK(mapped_to("my ramp").is_cube());
  CHECK(mapped_to("stairs:slab_wood") == shape_of_material_name("stairs:slab_wood"));
  CHECK(mapped_to("minecraft:oak_planks").is_cube());
}

TEST_CASE("bad rows of a map are refused with their number", "[formats]") {
  const auto refusal = [](const MaterialMapRow& row) {
    const auto map = MaterialMap::of({{"first", "stone"}, row});
    REQUIRE_FALSE(map.has_value());
    CHECK(map.error().offset == 1);
    return std::string(map.error().what);
  };
  CHECK(refusal({"", "stone"}) == "names no material of the source");
  CHECK(refusal({"a", ""}) == "names no material");
  CHECK(refusal({"a", std::string(65, 'x')}) == "must be a name of at most 64 bytes");
  CHECK(refusal({"a", "line\n"}) == "must be a name without control characters");
  CHECK(refusal({std::string(513, 'x'), "a"}) == "is longer than 512 bytes");
  CHECK(refusal({"a*b", "c"}).starts_with("has a * before its end"));
  CHECK(refusal({"**", "c"}).starts_with("has a * before its end"));
  CHECK(refusal({"first", "c"}) == "is there twice");
  CHECK(MaterialMap::of({{"first", "a"}, {"first*", "b"}}).has_value());
}

TEST_CASE("the rows that applied to nothing are listed, at most eight of them", "[formats]") {
  std::vector<MaterialMapRow> rows;
  for (int i = 0; i < 12; ++i) rows.push_back({"m" + std::to_string(i), "stone"});
  const MaterialMap map = map_of(rows);
  CHECK(unused_rows_text(map, {0, 2}) ==
        "\"m1\", \"m3\", \"m4\", \"m5\", \"m6\", \"m7\", \"m8\", \"m9\" and 2 more");
  AppliedRows all;
  for (std::size_t i = 0; i < rows.size(); ++i) all.insert(i);
  CHECK(unused_rows_text(map, all).empty());
}

TEST_CASE("a mapped build has the same cells with other materials", "[formats]") {
  const std::vector<BuildMaterial> materials = {file_material("air", "", {0, 0, 0, 0}),
                                                grey("m:a"),
                                                grey("m:b"),
                                                grey("m:b", "half=top"),
                                                grey("m:water"),
                                                file_material("z", "", {1, 2, 3, 255})};
  SplitMix64 rng(3);
  const FileBuild build = file_build({30, 20, 70}, materials, [&](VoxelPos) {
    return static_cast<std::uint16_t>(rng.below(static_cast<std::uint32_t>(materials.size()) + 1));
  });
  const MaterialMap map = map_of({{"m:a", "z"}, {"m:b", "m:a"}, {"m:water", "air"}});
  AppliedRows applied;
  const auto mapped = mapped_build(build, map, applied);
  REQUIRE(mapped.has_value());
  CHECK(applied == AppliedRows{0, 1, 2});
  CHECK(mapped->materials.size() == mapped->build->palette().size());
  CHECK(mapped->info == build.info);
  std::vector<std::string> names;
  for (const BuildMaterial& material : mapped->materials) names.push_back(material.row.name);
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"air", "m:a", "z"});
  for (std::int32_t z = 0; z < 70; ++z) {
    for (std::int32_t y = 0; y < 20; ++y) {
      for (std::int32_t x = 0; x < 30; ++x) {
        const auto before = build.build->at({x, y, z}), after = mapped->build->at({x, y, z});
        REQUIRE(before.has_value() == after.has_value());
        if (!before) continue;
        const MaterialRow& old = build.materials[*build.build->number_of(*before) - 1U].row;
        const MaterialRow& now = mapped->materials[*mapped->build->number_of(*after) - 1U].row;
        const std::string expected = old.name == "m:a"       ? "z"
                                     : old.name == "m:b"     ? "m:a"
                                     : old.name == "m:water" ? "air"
                                                             : old.name;
        REQUIRE(now.name == expected);
        REQUIRE((*after == kEmpty) == (expected == "air"));
        // The material that stays says what it looks like.
        if (expected == "z") REQUIRE(now.colour == MaterialColour{1, 2, 3, 255});
      }
    }
  }
}

}  // namespace runstone::test
