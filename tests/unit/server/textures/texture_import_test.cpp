// Folders of pictures: by names, of games of Luanti, and of resource packs of Minecraft.
#include "server/textures/texture_import.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <set>

#include "common/textures/texture_picture.hpp"
#include "server/textures/side_pictures.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/textures/test_png.hpp"

namespace runstone::test {
namespace {

Bytes picture(std::uint8_t red, std::uint32_t width = 16, std::uint32_t height = 16) {
  return plain_png(width, height, {red, 10, 10, 255});
}

MaterialTable table_of_names(std::initializer_list<const char*> names) {
  MaterialTable table;
  for (const char* name : names) {
    MaterialInfo info;
    info.name = name;
    info.colour = {40, 120, 40, 255};
    info.visibility = Visibility::opaque;
    REQUIRE(table.add(info).has_value());
  }
  return table;
}

void write_text(const std::string& path, const std::string& text) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::ofstream(path) << text;
}

/// The red of the picture that each side of a material shows, or -1.
struct Shown {
  Shown(const TextureImport& found) {
    for (const auto& given : found.textures) {
      const auto read = read_texture(given->png);
      REQUIRE(read.has_value());
      REQUIRE(table
                  .add(TextureEntry{{static_cast<std::uint8_t>(table.entries().size())},
                                    static_cast<std::uint32_t>(given->png.size()),
                                    given->uses})
                  .has_value());
      reds.push_back(read->rgba[0]);
    }
  }
  int operator()(Material material, Direction side) const {
    const std::uint16_t number = table.number(material, side);
    return number == 0 ? -1 : reds[number - 1U];
  }
  TextureTable table;
  std::vector<int> reds;
};

TextureImport found_in(const std::string& place, const MaterialTable& materials,
                       const TextureTable& present = {}) {
  auto found = import_textures(place, materials, present);
  if (!found) FAIL(found.error());
  return *std::move(found);
}

}  // namespace

TEST_CASE("a folder of pictures is matched by the names of materials", "[textures]") {
  const TempFolder folder;
  write_file(folder / "stone.png", picture(1));
  write_file(folder / "deep/mod_log.png", picture(2));
  write_file(folder / "deep/mod_log_top.png", picture(3));
  write_file(folder / "oven_front.png", picture(4));
  write_file(folder / "oven_side.png", picture(5));
  write_file(folder / "oven_top.png", picture(6));
  const MaterialTable materials =
      table_of_names({"minecraft:stone", "mod:log[axis=x]", "x:oven[facing=east]", "sand", "oven"});
  const TextureImport found = found_in(folder.path(), materials);
  const Shown shown(found);
  using enum Direction;
  CHECK(shown(1, neg_x) == 1);
  CHECK(shown(2, pos_x) == 3);
  CHECK(shown(2, neg_x) == 3);
  CHECK(shown(2, pos_y) == 2);
  CHECK(shown(2, pos_z) == 2);
  CHECK(shown(3, pos_x) == 4);
  CHECK(shown(3, neg_x) == 5);
  CHECK(shown(3, pos_y) == 6);
  CHECK(shown(4, pos_y) == -1);
  CHECK(shown(5, neg_z) == 4);
  CHECK(found.materials == 4);
  CHECK(found.pictures == 6);
  CHECK(found.without == 1);
  const std::string text = textures_text(found);
  CHECK(text.find("6 pictures for 4 materials") != std::string::npos);
  CHECK(text.find("no picture there for 1 material: sand") != std::string::npos);
}

TEST_CASE("sides that have a picture keep it, and one file is a folder of one", "[textures]") {
  const TempFolder folder;
  write_file(folder / "stone.png", picture(1));
  const MaterialTable materials = table_of_names({"stone"});
  TextureTable present;
  REQUIRE(present.add(TextureEntry{{9}, 10, {{1, 1}}}).has_value());
  const TextureImport found = found_in(folder / "stone.png", materials, present);
  REQUIRE(found.textures.size() == 1);
  CHECK(found.textures[0]->uses == std::vector<TextureUse>{{1, kAllTextureSides - 1}});
  CHECK(found.sides == 5);
  CHECK(found.sides_before == 1);
  CHECK_FALSE(import_textures(folder / "none", materials, {}).has_value());
}

TEST_CASE("pictures beyond the limit of a world are left out, and the limit is named",
          "[textures]") {
  const TempFolder folder;
  MaterialTable materials;
  for (std::size_t i = 0; i <= kTextureCountMax; ++i) {
    MaterialInfo info;
    info.name = "m" + std::to_string(i);
    info.visibility = Visibility::opaque;
    REQUIRE(materials.add(info).has_value());
    const std::array<std::uint8_t, 4> rgba{static_cast<std::uint8_t>(i),
                                           static_cast<std::uint8_t>(i >> 8), 0, 255};
    write_file(folder / (info.name + ".png"), plain_png(16, 16, rgba));
  }
  const TextureImport found = found_in(folder.path(), materials);
  CHECK(found.pictures == kTextureCountMax);
  CHECK(found.materials == kTextureCountMax);
  CHECK(found.textures.size() == kTextureCountMax);
  CHECK(found.faults == 1);
  CHECK(textures_text(found).find("the world has 4,096 pictures, which is the most") !=
        std::string::npos);
}

TEST_CASE("pictures of other sizes are cut and scaled, and hostile ones are named", "[textures]") {
  const TempFolder folder;
  write_file(folder / "strip.png", picture(1, 16, 64));
  write_file(folder / "large.png", picture(2, 256, 256));
  write_file(folder / "tiny.png", picture(3, 8, 8));
  write_file(folder / "odd.png", picture(4, 20, 20));
  write_file(folder / "wide.png", bytes_of({16'384, 16'384, 8, 6, {0}}));
  write_file(folder / "text.png", {'h', 'e', 'l', 'l', 'o'});
  Bytes cut = picture(5);
  cut.resize(40);
  write_file(folder / "cut.png", cut);
  const MaterialTable materials =
      table_of_names({"strip", "large", "tiny", "odd", "wide", "text", "cut"});
  const TextureImport found = found_in(folder.path(), materials);
  const Shown shown(found);
  CHECK(shown(1, Direction::pos_y) == 1);
  CHECK(shown(2, Direction::pos_y) == 2);
  CHECK(shown(3, Direction::pos_y) == 3);
  REQUIRE(found.textures.size() == 3);
  CHECK(*texture_edge(found.textures[0]->png) == 16);
  CHECK(*texture_edge(found.textures[1]->png) == 64);
  CHECK(*texture_edge(found.textures[2]->png) == 16);
  CHECK(found.faults == 4);
  const std::string text = textures_text(found);
  CHECK(text.find("wide.png: has 16384 x 16384 pixels") != std::string::npos);
  CHECK(text.find("text.png: is no PNG") != std::string::npos);
}

TEST_CASE("a game of Luanti says its tiles in Lua", "[textures]") {
  const TempFolder folder;
  write_text(folder / "game.conf", "title = x\n");
  write_text(folder / "mods/default/init.lua", R"lua(
-- minetest.register_node("default:no", {tiles = {"no.png"}})
minetest.register_node("default:stone", {
  description = S("Stone"),
  tiles = {"default_stone.png"},
  drop = {items = {{items = {"default:cobble"}}}},
})
core.register_node(":default:chest", {
  tiles = {"c_top.png", "c_top.png", "c_side.png", {name = "c_side.png", scale = 2},
           "c_side.png", "c_front.png^over.png"},
})
minetest.register_node("default:made", {tiles = {prefix .. "_a.png", "default_stone.png"}})
minetest.register_node("default:" .. name, {tiles = {"default_stone.png"}})
stairs.register_stair_and_slab("stone", "default:stone", {cracky = 3}, {"x.png"})
)lua");
  std::uint8_t red = 1;
  for (const char* name : {"default_stone", "c_top", "c_side", "c_front"})
    write_file(folder / ("mods/default/textures/" + std::string(name) + ".png"), picture(red++));
  write_file(folder / "mods/default/textures/over.png", plain_png(16, 16, {99, 10, 10, 255}));
  const MaterialTable materials =
      table_of_names({"default:stone", "default:chest", "default:chest[param2=1]", "default:made",
                      "stairs:slab_stone[param2=20]", "default:no"});
  const TextureImport found = found_in(folder.path(), materials);
  const Shown shown(found);
  using enum Direction;
  CHECK(shown(1, neg_x) == 1);
  CHECK(shown(2, pos_y) == 2);
  CHECK(shown(2, neg_x) == 3);
  CHECK(shown(2, neg_z) == 99);
  // A facedir of 1 turns -z to -x.
  CHECK(shown(3, neg_x) == 99);
  CHECK(shown(3, neg_z) == 3);
  CHECK(shown(4, pos_y) == -1);
  CHECK(shown(4, neg_y) == 1);
  CHECK(shown(5, pos_x) == 1);
  CHECK(shown(6, pos_x) == -1);
  CHECK(found.kind == "a game or mod of Luanti");
}

TEST_CASE("a resource pack of Minecraft says its textures by models", "[textures]") {
  const TempFolder folder;
  const std::string mc = folder / "assets/minecraft/";
  write_text(mc + "models/block/cube.json", R"({"elements": [{"faces": {
    "down": {"texture": "#down"}, "up": {"texture": "#up"}, "north": {"texture": "#north"},
    "south": {"texture": "#south"}, "west": {"texture": "#west"}, "east": {"texture": "#east"}}}]})");
  write_text(mc + "models/block/orientable.json", R"({"parent": "block/cube", "textures": {
    "down": "#top", "up": "#top", "north": "#front", "south": "#side", "west": "#side", "east": "#side"}})");
  write_text(mc + "models/block/furnace.json",
             R"({"parent": "minecraft:block/orientable", "textures": {
    "top": "minecraft:block/furnace_top", "front": "block/furnace_front", "side": "block/furnace_side"}})");
  write_text(mc + "blockstates/furnace.json", R"({"variants": {
    "facing=east,lit=false": {"model": "minecraft:block/furnace", "y": 90},
    "facing=north,lit=false": {"model": "minecraft:block/furnace"}}})");
  write_text(mc + "models/block/grass_block.json", R"({"textures": {"all": "block/grass"},
    "elements": [{"faces": {"up": {"texture": "#all", "tintindex": 0}}}]})");
  write_text(mc + "blockstates/grass_block.json",
             R"({"variants": {"snowy=false": [{"model": "block/grass_block"}]}})");
  write_text(mc + "blockstates/stone.json", R"({"variants": {"": {"model": "../../secret"}}})");
  write_text(mc + "blockstates/dirt.json", "{");
  write_file(mc + "textures/block/furnace_top.png", picture(1));
  write_file(mc + "textures/block/furnace_front.png", picture(2));
  write_file(mc + "textures/block/furnace_side.png", picture(3));
  write_file(mc + "textures/block/grass.png", plain_png(16, 16, {100, 100, 100, 255}));
  const MaterialTable materials =
      table_of_names({"minecraft:furnace[facing=east]", "minecraft:furnace",
                      "minecraft:grass_block", "minecraft:stone", "minecraft:dirt", "sand"});
  const TextureImport found = found_in(folder.path(), materials);
  const Shown shown(found);
  using enum Direction;
  CHECK(shown(1, pos_x) == 2);
  CHECK(shown(1, neg_z) == 3);
  CHECK(shown(1, pos_y) == 1);
  CHECK(shown(2, neg_z) == 2);
  CHECK(shown(2, pos_x) == 3);
  // A grey picture that is tinted gets the colour of the material.
  CHECK(shown(3, pos_y) == 40);
  CHECK(found.without == 3);
}

TEST_CASE("files of Minecraft that are nested deep are read without what is deep", "[textures]") {
  const TempFolder folder;
  const std::string mc = folder / "assets/minecraft/";
  constexpr std::size_t kDeep = 500'000;
  const std::string nested = std::string(kDeep, '[') + std::string(kDeep, ']');
  write_text(mc + "blockstates/when.json", R"({"multipart": [{"when": {"facing": )" + nested +
                                               R"(}, "apply": {"model": "block/stone"}}]})");
  write_text(mc + "blockstates/beside.json",
             R"({"x": )" + nested + R"(, "variants": {"": {"model": "block/stone"}}})");
  write_text(mc + "models/block/stone.json", R"({"textures": {"particle": "block/stone"}})");
  write_file(mc + "textures/block/stone.png", picture(7));
  const MaterialTable materials =
      table_of_names({"minecraft:when[facing=east]", "minecraft:beside"});
  const TextureImport found = found_in(folder.path(), materials);
  const Shown shown(found);
  CHECK(shown(1, Direction::pos_y) == -1);
  CHECK(shown(2, Direction::pos_y) == 7);
}

TEST_CASE("of more layers than eight the upper ones are left out", "[textures]") {
  const TempFolder folder;
  write_text(folder / "game.conf", "title = x\n");
  std::string tile;
  for (std::uint8_t i = 1; i <= kPictureLayersMax + 1; ++i) {
    const std::string name = "p" + std::to_string(i) + ".png";
    write_file(folder / ("mods/a/textures/" + name), picture(i));
    tile += (i == 1 ? "" : "^") + name;
  }
  write_text(folder / "mods/a/init.lua",
             "minetest.register_node(\"a:many\", {tiles = {\"" + tile + "\"}})\n");
  const TextureImport found = found_in(folder.path(), table_of_names({"a:many"}));
  CHECK(Shown(found)(1, Direction::pos_y) == kPictureLayersMax);
}

TEST_CASE("an import ends when it is cancelled, also while no picture is found", "[textures]") {
  const TempFolder folder;
  write_file(folder / "other.png", picture(1));
  const MaterialTable materials = table_of_names({"stone", "sand", "dirt"});
  int calls = 0;
  const auto cancelled = import_textures(folder.path(), materials, {}, [&] { return ++calls < 2; });
  REQUIRE_FALSE(cancelled.has_value());
  CHECK(cancelled.error() == folder.path() + ": was cancelled");
  CHECK(calls == 2);
}

}  // namespace runstone::test
