#include "common/generate/generator.hpp"

#include <catch2/catch.hpp>

#include "common/generate/generator_parameters.hpp"

using namespace runstone;

namespace {

ErrorCode code_of(const GeneratorPin& pin, const MaterialTable& table = default_material_table()) {
  const auto made = make_generator(pin, table);
  REQUIRE_FALSE(made.has_value());
  return made.error().code;
}

}  // namespace

TEST_CASE("a build rejects pins of generators that it lacks", "[generate]") {
  CHECK(code_of({"", 1, 0, ""}) == ErrorCode::not_found);
  CHECK(code_of({"caves", 1, 0, ""}) == ErrorCode::not_found);
  for (const char* name : {"empty", "flat", "terrain"}) {
    CHECK(code_of({name, 0, 0, ""}) == ErrorCode::bad_version);
    CHECK(code_of({name, 2, 0, ""}) == ErrorCode::bad_version);
    CHECK(code_of({name, 1, 0, "colour = 3"}) == ErrorCode::bad_value);
    CHECK(make_generator({name, 1, 0, ""}, default_material_table()).has_value());
  }
}

TEST_CASE("a build rejects parameters that it cannot use", "[generate]") {
  CHECK(code_of({"flat", 1, 0, "height = \"7\""}) == ErrorCode::bad_value);
  CHECK(code_of({"flat", 1, 0, "surface = 7"}) == ErrorCode::bad_value);
  CHECK(code_of({"flat", 1, 0, "height = 100001"}) == ErrorCode::bad_value);
  CHECK(code_of({"flat", 1, 0, "height = -65"}) == ErrorCode::bad_value);
  CHECK(code_of({"flat", 1, 0, "height"}) == ErrorCode::bad_value);
  CHECK(code_of({"flat", 1, 0, "surface = \"cheese\""}) == ErrorCode::not_found);
  CHECK(code_of({"terrain", 1, 0, "peak = \"cheese\""}) == ErrorCode::not_found);
  CHECK(code_of({"terrain", 1, 0, "y_min = 5000"}) == ErrorCode::bad_value);
  CHECK(code_of({"terrain", 1, 0, ""}, MaterialTable()) == ErrorCode::not_found);
}

TEST_CASE("terrain needs generation rules, but not too many", "[generate]") {
  const GeneratorPin bare{"terrain", 1, 0,
                          "water = \"\"\nbeach = \"\"\nrock = \"\"\npeak = \"\"\n"};
  CHECK(code_of(bare, MaterialTable()) == ErrorCode::not_found);
  MaterialTable table;
  for (int i = 0; i < 64; ++i) {
    REQUIRE(
        table.add({"m" + std::to_string(i), {1, 2, 3, 255}, Visibility::opaque, GenerationRule{}})
            .has_value());
  }
  CHECK(make_generator(bare, table).has_value());
  REQUIRE(table.add({"last", {1, 2, 3, 255}, Visibility::opaque, GenerationRule{}}).has_value());
  CHECK(code_of(bare, table) == ErrorCode::limit_exceeded);
}

TEST_CASE("parameters have one canonical text that reads back", "[generate]") {
  CHECK(to_toml(FlatParameters{}).empty());
  CHECK(to_toml(TerrainParameters{}).empty());
  CHECK(*parse_flat_parameters("") == FlatParameters{});
  CHECK(*parse_terrain_parameters("") == TerrainParameters{});

  const FlatParameters flat{12, -3, 7, "sand", "", "a \"b\\c"};
  CHECK(to_toml(flat) ==
        "height = 12\n"
        "y_min = -3\n"
        "filling_depth = 7\n"
        "surface = \"sand\"\n"
        "filling = \"\"\n"
        "ground = \"a \\\"b\\\\c\"\n");
  CHECK(*parse_flat_parameters(to_toml(flat)) == flat);
  const TerrainParameters terrain{1, -2, "", "clay", -5, "slate", 9, "gold", 10};
  CHECK(to_toml(terrain) ==
        "sea_level = 1\n"
        "y_min = -2\n"
        "water = \"\"\n"
        "beach = \"clay\"\n"
        "beach_height = -5\n"
        "rock = \"slate\"\n"
        "rock_level = 9\n"
        "peak = \"gold\"\n"
        "peak_level = 10\n");
  CHECK(*parse_terrain_parameters(to_toml(terrain)) == terrain);
}

TEST_CASE("the empty world is empty", "[generate]") {
  const auto empty = make_generator({"empty", 1, 0, ""}, default_material_table());
  REQUIRE(empty.has_value());
  for (const std::int32_t y : {-64, -32, 0, 32}) {
    CHECK((*empty)->generate({0, y, 0}, Extent::cube(32)) ==
          uniform_chunk(Extent::cube(32), kEmpty));
  }
  CHECK((*empty)->y_min() == (*empty)->y_max());
}

TEST_CASE("a flat world has its layers at their heights", "[generate]") {
  const MaterialTable& table = default_material_table();
  const auto flat =
      make_generator({"flat", 1, 0, "height = 5\ny_min = -10\nfilling_depth = 2"}, table);
  REQUIRE(flat.has_value());
  const auto at = [&](std::int32_t y) {
    const VoxelPos pos{7, y, -40};
    const RunChunk chunk = (*flat)->generate(origin_of(chunk_of(pos, 16), 16), Extent::cube(16));
    REQUIRE(validate(chunk).has_value());
    return table[material_at(chunk, local_of(pos, 16))].name;
  };
  CHECK(at(5) == "air");
  CHECK(at(4) == "grass");
  CHECK(at(3) == "dirt");
  CHECK(at(2) == "dirt");
  CHECK(at(1) == "stone");
  CHECK(at(-10) == "stone");
  CHECK(at(-11) == "air");
  CHECK((*flat)->surface_y(1000, -3) == 5);
  CHECK((*flat)->y_min() == -10);
  CHECK((*flat)->y_max() == 5);
}

TEST_CASE("a flat world may have no voxels, or air on top", "[generate]") {
  const auto none =
      make_generator({"flat", 1, 0, "height = 5\ny_min = 5"}, default_material_table());
  REQUIRE(none.has_value());
  CHECK((*none)->generate({0, 0, 0}, Extent::cube(16)).is_uniform());
  const auto pit = make_generator({"flat", 1, 0, "surface = \"air\""}, default_material_table());
  REQUIRE(pit.has_value());
  CHECK((*pit)->y_max() == -1);
  CHECK((*pit)->surface_y(0, 0) == -1);
}
