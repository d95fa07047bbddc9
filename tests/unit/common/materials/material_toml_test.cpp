#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/materials/material_table.hpp"
#include "tests/support/core/random_look.hpp"

using namespace runstone;

namespace {

constexpr const char* kAir = "[[material]]\nname = \"air\"\nvisibility = \"empty\"\n";

TextError error_of(const std::string& toml) {
  const auto table = parse_material_table(toml, "m.toml");
  REQUIRE_FALSE(table.has_value());
  return table.error();
}

/// Returns the error of a table whose second row, from line 4 on, is `row`.
TextError row_error(const std::string& row) { return error_of(kAir + ("[[material]]\n" + row)); }

MaterialTable random_table(SplitMix64& random) {
  MaterialTable table;
  const auto surface = [&] {
    return SurfaceRule{random.between(-1000, 1000), random.between(-10000, 10000) / 7.0,
                       random.between(-10000, 10000) / 3.0, random.between(1, 1000) / 1000.0};
  };
  const std::uint32_t rows = random.below(40);
  for (std::uint32_t i = 0; i < rows; ++i) {
    MaterialInfo info;
    info.name = "m\"\\ \xc3\xa4" + std::to_string(i);
    info.visibility = static_cast<Visibility>(random.below(3));
    for (auto& channel : info.colour) channel = static_cast<std::uint8_t>(random.below(256));
    if (info.visibility == Visibility::opaque) info.colour[3] = 255;
    if (info.visibility != Visibility::empty)
      info.body = static_cast<MaterialBody>(random.below(3));
    if (random.below(2) == 0) info.look = test::random_look(random);
    if (info.visibility != Visibility::empty && random.below(2) == 0) {
      const auto low = static_cast<std::uint8_t>(random.below(16));
      info.shape.form = static_cast<ShapeForm>(random.below(2));
      info.shape.boxes = {{{low, 0, 3}, {16, 8, 5}}, {{0, low, low}, {1, 16, 16}}};
    }
    if (random.below(2) == 0) info.generation = GenerationRule{surface(), std::nullopt};
    if (info.generation && random.below(2) == 0) info.generation->reversed = surface();
    REQUIRE(table.add(info).has_value());
  }
  return table;
}

}  // namespace

TEST_CASE("a table reads with every key", "[materials]") {
  const auto table = parse_material_table(R"(
[[material]]
name = "air"
colour = "#00000000"
visibility = "empty"
[[material]]
name = "rock"   # visibility is opaque unless given
colour = "#0a0BfF"
[material.generate]
surface = { seed = -3, elevation = 12, distance = 1.5, frequency = 0.25 }
reversed = { elevation = 4.0 }
[[material]]
name = "mist"
colour = "#01020304"
visibility = "transparent"
look = { emission = 100 }
[[material]]
name = "hedge"
colour = "#102030"
[material.look]
variation = 0
grain = 1
roughness = 99
emission = 3
pattern = "bark"
)",
                                          "m.toml");
  REQUIRE(table.has_value());
  REQUIRE(table->size() == 4);
  const MaterialInfo& rock = (*table)[1];
  CHECK(rock.name == "rock");
  CHECK(rock.colour == std::array<std::uint8_t, 4>{10, 11, 255, 255});
  CHECK(rock.visibility == Visibility::opaque);
  REQUIRE(rock.generation.has_value());
  CHECK(rock.generation->surface == SurfaceRule{-3, 12, 1.5, 0.25});
  CHECK(rock.generation->reversed == SurfaceRule{1, 4, 0, 0.007});
  CHECK_FALSE(rock.look.has_value());
  CHECK((*table)[2].colour == std::array<std::uint8_t, 4>{1, 2, 3, 4});
  MaterialLook bright;  // keys that are not given have their defaults
  bright.emission = 100;
  CHECK((*table)[2].look == bright);
  CHECK((*table)[3].look == MaterialLook{0, 1, 99, 3, MaterialPattern::bark});
}

TEST_CASE("a table round trips through text", "[materials]") {
  const auto back = parse_material_table(to_toml(default_material_table()), "default");
  REQUIRE(back.has_value());
  CHECK(*back == default_material_table());

  SplitMix64 random(Catch::rngSeed());
  for (int i = 0; i < 100; ++i) {
    const MaterialTable table = random_table(random);
    const std::string text = to_toml(table);
    CAPTURE(text);
    const auto again = parse_material_table(text, "random");
    REQUIRE(again.has_value());
    REQUIRE(*again == table);
    REQUIRE(to_toml(*again) == text);
  }
}

TEST_CASE("an error names file, line and key", "[materials]") {
  const TextError error = row_error("name = \"rock\"\ncolour = \"red\"\n");
  CHECK(error.file == "m.toml");
  CHECK(error.line == 6);
  CHECK(error.key == "material[1].colour");
  CHECK(error.message() == "m.toml:6: material[1].colour: must be \"#rrggbb\" or \"#rrggbbaa\"");
  CHECK(TextError{"f", 0, "", "gone"}.message() == "f: gone");
}

TEST_CASE("every mistake in a row is reported at its key", "[materials]") {
  struct Case {
    const char* row;
    std::uint32_t line;
    const char* key;
  };
  const std::string head = "name = \"r\"\ncolour = \"#102030\"\n";
  const Case cases[] = {
      {"colour = \"#102030\"\n", 4, "material[1].name"},
      {"name = \"r\"\n", 4, "material[1].colour"},
      {"name = 7\ncolour = \"#102030\"\n", 5, "material[1].name"},
      {"name = \"r\"\ncolour = \"#10203\"\n", 6, "material[1].colour"},
      {"name = \"r\"\ncolour = \"#10203g\"\n", 6, "material[1].colour"},
      {"name = \"r\"\ncolour = \"#+1+2+3\"\n", 6, "material[1].colour"},
      {"name = \"r\"\ncolour = 1\n", 6, "material[1].colour"},
      {"name = \"r\"\ncolour = \"#102030\"\nvisibility = \"glassy\"\n", 7,
       "material[1].visibility"},
      {"name = \"r\"\ncolour = \"#102030\"\nbody = \"soft\"\n", 7, "material[1].body"},
      {"name = \"r\"\ncolour = \"#102030\"\ncolor = \"#102030\"\n", 7, "material[1].color"},
      {"name = \"r\"\ncolour = \"#10203040\"\n", 4, "material[1]"},
      {"name = \"air\"\ncolour = \"#102030\"\n", 4, "material[1]"},
      {"name = \"r\"\ncolour = \"#102030\"\ngenerate = 3\n", 7, "material[1].generate"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.generate]\n", 7,
       "material[1].generate.surface"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.generate]\nsurface = 1\n", 8,
       "material[1].generate.surface"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.generate]\nsurface = { depth = 1 }\n", 8,
       "material[1].generate.surface.depth"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.generate]\nsurface = { seed = 0.5 }\n", 8,
       "material[1].generate.surface.seed"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.generate]\nsurface = { seed = 4294967296 }\n",
       8, "material[1].generate.surface.seed"},
      {"name = \"r\"\n"
       "colour = \"#102030\"\n"
       "[material.generate]\n"
       "surface = {}\n"
       "reversed = { elevation = \"1\" }\n",
       9, "material[1].generate.reversed.elevation"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.generate]\nsurface = {}\nupper = {}\n", 9,
       "material[1].generate.upper"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.generate]\nsurface = { frequency = nan }\n",
       4, "material[1]"},
      {"name = \"r\"\ncolour = \"#102030\"\nlook = \"shiny\"\n", 7, "material[1].look"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.look]\nglow = 1\n", 8,
       "material[1].look.glow"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.look]\nemission = 101\n", 8,
       "material[1].look.emission"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.look]\nvariation = -1\n", 8,
       "material[1].look.variation"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.look]\nroughness = 0.5\n", 8,
       "material[1].look.roughness"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.look]\npattern = \"stripes\"\n", 8,
       "material[1].look.pattern"},
      {"name = \"r\"\ncolour = \"#102030\"\n[material.look]\npattern = 1\n", 8,
       "material[1].look.pattern"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.row);
    const TextError error = row_error(c.row);
    CHECK(error.line == c.line);
    CHECK(error.key == c.key);
    CHECK_FALSE(error.what.empty());
  }
}

TEST_CASE("a file that is no table of materials is rejected", "[materials]") {
  CHECK(error_of("").key == "material");
  CHECK(error_of("material = []").key == "material");
  CHECK(error_of("material = 3").line == 1);
  CHECK(error_of("\n\nmaterial = [").line == 3);
  CHECK(error_of(std::string(kAir) + "[server]\nport = 1\n").key == "server");
}

TEST_CASE("the first material is air", "[materials]") {
  CHECK(parse_material_table(kAir, "m").has_value());
  CHECK(error_of("[[material]]\nname = \"stone\"\ncolour = \"#101010\"\n").key == "material[0]");
  CHECK(error_of("[[material]]\nname = \"air\"\ncolour = \"#101010\"\n").key == "material[0]");
  CHECK(error_of("[[material]]\n"
                 "name = \"air\"\n"
                 "visibility = \"empty\"\n"
                 "[material.generate]\n"
                 "surface = {}\n")
            .key == "material[0]");
}

TEST_CASE("a file of added materials has rows with their lines, without air", "[materials]") {
  const auto rows = parse_material_rows(
      "# wool\n[[material]]\nname = \"lime\"\ncolour = \"#80ff20\"\n\n"
      "[[material]]\nname = \"ice\"\ncolour = \"#a0c0ff80\"\nvisibility = \"transparent\"\n"
      "look = { roughness = 9 }\n",
      "wool.toml");
  REQUIRE(rows.has_value());
  REQUIRE(rows->size() == 2);
  CHECK((*rows)[0].row == MaterialRow{"lime", {0x80, 0xff, 0x20, 0xff}, Visibility::opaque});
  CHECK((*rows)[0].line == 2);
  const MaterialRow ice{"ice",
                        {0xa0, 0xc0, 0xff, 0x80},
                        Visibility::transparent,
                        MaterialBody::solid,
                        MaterialLook{10, 8, 9, 0, MaterialPattern::none}};
  CHECK((*rows)[1].row == ice);
  CHECK((*rows)[1].line == 6);
}

TEST_CASE("an error in a file of added materials names file, line and key", "[materials]") {
  const auto message = [](const std::string& toml) {
    const auto rows = parse_material_rows(toml, "wool.toml");
    REQUIRE_FALSE(rows.has_value());
    return rows.error().message();
  };
  CHECK(message("") == "wool.toml: material: is missing");
  CHECK(message("[[material]]\nname = 3\n") == "wool.toml:2: material[0].name: must be a string");
  CHECK(message("[[material]]\nname = \"a\"\ncolour = \"#80\"\n") ==
        "wool.toml:3: material[0].colour: must be \"#rrggbb\" or \"#rrggbbaa\"");
  CHECK(message("[[material]]\nname = \"a\"\ncolour = \"#808080\"\n"
                "[material.generate]\nsurface = {}\n") ==
        "wool.toml:4: material[0].generate: a material that is added later cannot be terrain");
  const std::string twice = "[[material]]\nname = \"a\"\ncolour = \"#808080\"\n";
  CHECK(message(twice + twice) == "wool.toml:4: material[1]: name is already taken");
  CHECK(message("[[material]]\nname = \"air\"\nvisibility = \"empty\"\n") ==
        "wool.toml:1: material[0]: name is already taken");
}

TEST_CASE("a material has boxes, crossed planes or a built-in kind", "[materials][shapes]") {
  const auto table = parse_material_table(kAir + std::string(R"(
[[material]]
name = "shelf"
colour = "#102030"
shape = [[0, 12, 0, 16, 16, 8], [0, 0, 0, 2, 12, 2]]
[[material]]
name = "reed"
colour = "#102030"
crossed = [[1, 0, 1, 15, 14, 15]]
[[material]]
name = "oak_stairs[facing=east,half=top]"
colour = "#102030"
shape = "stairs"
[[material]]
name = "oak_slab[type=double]"
colour = "#102030"
shape = "slab"
)"),
                                          "m.toml");
  REQUIRE(table);
  CHECK((*table)[1].shape ==
        Shape{ShapeForm::boxes, {{{0, 12, 0}, {16, 16, 8}}, {{0, 0, 0}, {2, 12, 2}}}});
  CHECK((*table)[2].shape == Shape{ShapeForm::crossed, {{{1, 0, 1}, {15, 14, 15}}}});
  CHECK((*table)[3].shape ==
        Shape{ShapeForm::boxes, {{{0, 8, 0}, {16, 16, 16}}, {{8, 0, 0}, {16, 8, 16}}}});
  CHECK((*table)[4].shape.is_cube());
  CHECK(to_toml(*table).find("shape = [[0,12,0,16,16,8], [0,0,0,2,12,2]]\n") != std::string::npos);
  CHECK(to_toml(*table).find("crossed = [[1,0,1,15,14,15]]\n") != std::string::npos);
  const auto read = parse_material_table(to_toml(*table), "m.toml");
  REQUIRE(read);
  CHECK(*read == *table);
  const auto rows = parse_material_rows(R"(
[[material]]
name = "oak_slab[type=top]"
colour = "#102030"
shape = "slab"
)",
                                        "m.toml");
  REQUIRE(rows);
  CHECK(rows->front().row.shape == Shape{ShapeForm::boxes, {{{0, 8, 0}, {16, 16, 16}}}});
}

TEST_CASE("errors in a shape name line and key", "[materials][shapes]") {
  const std::string head = "name = \"a\"\ncolour = \"#102030\"\n";
  const auto check = [&](const std::string& text, const std::string& key) {
    const TextError error = row_error(head + text);
    CAPTURE(text, error.what);
    CHECK(error.line == 7);
    CHECK(error.key == key);
    return error.what;
  };
  CHECK(check("shape = \"slap\"\n", "material[1].shape").find("slab") != std::string::npos);
  check("shape = 3\n", "material[1].shape");
  check("shape = []\n", "material[1].shape");
  check("shape = [[0,0,0,16,16]]\n", "material[1].shape");
  check("shape = [[0,0,0,16,17,16]]\n", "material[1].shape");
  check("shape = [[0,0,0,16,8.0,16]]\n", "material[1].shape");
  check("shape = [[0,0,0,16,0,16]]\n", "material[1].shape");
  check("crossed = [[0,-1,0,16,8,16]]\n", "material[1].crossed");
  check("crossed = \"plant\"\n", "material[1].crossed");
  check("crossed = [[0,0,0,16,8,16]]\nshape = \"slab\"\n", "material[1].crossed");
  std::string many = "shape = [";
  for (int i = 0; i < 33; ++i) many += "[0,0,0,16,8,16],";
  check(many + "]\n", "material[1].shape");
  const TextError empty = row_error("name = \"a\"\nvisibility = \"empty\"\nshape = \"slab\"\n");
  CHECK(empty.line == 7);
  CHECK(empty.key == "material[1].shape");
}
