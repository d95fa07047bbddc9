#include "common/formats/minecraft_blocks.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "common/core/hash.hpp"
#include "common/formats/minecraft_states.hpp"

using namespace runstone;

namespace {

std::string number_text(std::uint16_t id, std::uint8_t data) {
  const auto block = minecraft_block_of(id, data);
  if (!block) return "none";
  return block->name.substr(10) + (block->states.empty() ? "" : " " + block->states);
}

std::string name_of(const std::string& name, const std::string& states = "") {
  return minecraft_material_name({name, states});
}

/// Checks that the name of a block leads back to it.
void check_reversible(const ForeignBlock& block) {
  const std::string name = minecraft_material_name(block);
  CAPTURE(block.name, block.states, name);
  REQUIRE(name.size() <= kMaterialNameBytesMax);
  const auto back = block_of_minecraft_material(name);
  REQUIRE(back.has_value());
  CHECK(*back == with_default_states(block));
}

MaterialInfo look_at(const std::string& name, const std::string& states = "", bool all = false) {
  return material_of_minecraft_block({name, states}, all);
}

std::array<int, 3> rgb_of(const std::string& name) {
  const MaterialColour colour = look_at(name).colour;
  return {colour[0], colour[1], colour[2]};
}

}  // namespace

TEST_CASE("numbers of 1.12 are the blocks that they were", "[formats]") {
  CHECK(number_text(0, 0) == "air");
  CHECK(number_text(1, 5) == "andesite");
  CHECK(number_text(2, 0) == "grass_block snowy=false");
  CHECK(number_text(9, 3) == "water level=3");
  CHECK(number_text(17, 2 + 4) == "birch_log axis=x");
  CHECK(number_text(17, 12 + 3) == "jungle_wood axis=y");
  CHECK(number_text(18, 4) == "oak_leaves distance=1,persistent=true,waterlogged=false");
  CHECK(number_text(35, 14) == "red_wool");
  CHECK(number_text(43, 0) == "smooth_stone_slab type=double,waterlogged=false");
  CHECK(number_text(43, 8) == "smooth_stone");
  CHECK(number_text(43, 15) == "smooth_quartz");
  CHECK(number_text(44, 8 + 5) == "stone_brick_slab type=top,waterlogged=false");
  CHECK(number_text(50, 3) == "wall_torch facing=south");
  CHECK(number_text(50, 5) == "torch");
  CHECK(number_text(53, 4 + 2) ==
        "oak_stairs facing=south,half=top,shape=straight,waterlogged=false");
  CHECK(number_text(54, 5) == "chest facing=east,type=single,waterlogged=false");
  CHECK(number_text(62, 4) == "furnace facing=west,lit=true");
  CHECK(number_text(64, 4 + 1) ==
        "oak_door facing=south,half=lower,hinge=left,open=true,powered=false");
  CHECK(number_text(64, 8 + 1) ==
        "oak_door facing=north,half=upper,hinge=right,open=false,powered=false");
  CHECK(number_text(99, 7) ==
        "brown_mushroom_block down=false,east=false,north=false,south=true,up=true,west=true");
  CHECK(number_text(106, 1 + 8) == "vine east=true,north=false,south=true,up=false,west=false");
  CHECK(number_text(118, 2) == "water_cauldron level=2");
  CHECK(number_text(155, 3) == "quartz_pillar axis=x");
  CHECK(number_text(181, 8) == "smooth_red_sandstone");
  CHECK(number_text(228, 1) == "cyan_shulker_box facing=up");
  CHECK(number_text(250, 2) == "black_glazed_terracotta facing=north");
  CHECK(number_text(251, 3) == "light_blue_concrete");
  CHECK(number_text(255, 2) == "structure_block mode=corner");
  CHECK(number_text(253, 0) == "none");
  CHECK(number_text(256, 0) == "none");
  CHECK(number_text(1, 16) == "none");
}

TEST_CASE("every number of 1.12 is a block with known states", "[formats]") {
  std::size_t known = 0;
  for (std::uint16_t id = 0; id < 256; ++id) {
    for (std::uint8_t data = 0; data < 16; ++data) {
      const auto block = minecraft_block_of(id, data);
      if (!block) {
        CHECK((id == 253 || id == 254));
        continue;
      }
      ++known;
      CAPTURE(id, int{data}, block->name, block->states);
      const auto properties = minecraft_properties(block->name.substr(10));
      const auto states = split_states(block->states);
      REQUIRE(states.has_value());
      REQUIRE(states->size() == properties.size());
      for (std::size_t i = 0; i < properties.size(); ++i) {
        CHECK((*states)[i].first == key_of(properties[i]));
        CHECK(index_of_value(properties[i], (*states)[i].second).has_value());
      }
    }
  }
  CHECK(known == 254 * 16);
}

TEST_CASE("names of materials leave out the default states", "[formats]") {
  CHECK(name_of("minecraft:stone") == "minecraft:stone");
  CHECK(name_of("stone") == "minecraft:stone");
  CHECK(name_of("minecraft:oak_log", "axis=y") == "minecraft:oak_log");
  CHECK(name_of("minecraft:oak_log", "axis=x") == "minecraft:oak_log[axis=x]");
  CHECK(name_of("minecraft:oak_stairs", "facing=east,half=top,shape=straight,waterlogged=false") ==
        "minecraft:oak_stairs[facing=east,half=top]");
  // A key of a later version stays.
  CHECK(name_of("minecraft:oak_log", "axis=y,rings=7") == "minecraft:oak_log[rings=7]");
  CHECK(name_of("minecraft:air") == "air");
  CHECK(name_of("minecraft:cave_air") == "air");
  CHECK(name_of("mod:marble", "polish=2") == "mod:marble[polish=2]");
  CHECK(name_of("mod:fir_stairs", "facing=east,half=bottom,shape=straight,waterlogged=false") ==
        "mod:fir_stairs[facing=east]");
  CHECK(name_of("mod:fir_stairs", "facing=east") == "mod:fir_stairs{facing=east}");
  CHECK(name_of("mod:fir_stairs") == "mod:fir_stairs{}");
  CHECK(name_of("minecraft:polished_blackstone_brick_wall",
                "east=tall,north=low,south=none,up=true,waterlogged=true,west=tall") ==
        "minecraft:polished_blackstone_brick_wall~210012");
}

TEST_CASE("names of materials lead back to blocks", "[formats]") {
  for (const auto& [name, states] :
       std::map<std::string, std::string>{{"minecraft:stone", ""},
                                          {"minecraft:oak_log", "axis=z"},
                                          {"minecraft:oak_log", "axis=x,rings=7"},
                                          {"minecraft:new_block_of_2030", "charge=9,colour=red"},
                                          {"mod:fir_stairs", "facing=east"},
                                          {"mod:birch_slab", ""},
                                          {"mod:deep/er-name.x", "a=1"},
                                          {"numeric:300", "data=5"}})
    check_reversible({name, states});
  // Every state of the blocks with the longest names and the most states.
  for (const char* name :
       {"minecraft:waxed_weathered_cut_copper_stairs", "minecraft:polished_blackstone_brick_wall",
        "minecraft:redstone_wire", "minecraft:tripwire", "minecraft:light_gray_stained_glass_pane",
        "minecraft:calibrated_sculk_sensor", "minecraft:chiseled_bookshelf"}) {
    const auto properties = minecraft_properties(std::string_view(name).substr(10));
    REQUIRE_FALSE(properties.empty());
    std::size_t combinations = 1;
    for (const auto property : properties) combinations *= value_count(property);
    std::set<std::string> names;
    for (std::size_t i = 0; i < combinations; ++i) {
      StateList states;
      std::size_t rest = i;
      for (const auto property : properties) {
        states.emplace_back(key_of(property), value_of(property, rest % value_count(property)));
        rest /= value_count(property);
      }
      const ForeignBlock block{name, join_states(states)};
      check_reversible(block);
      names.insert(minecraft_material_name(block));
    }
    CHECK(names.size() == combinations);
  }
  CHECK(block_of_minecraft_material("air") == ForeignBlock{"minecraft:air", ""});
  CHECK(block_of_minecraft_material("minecraft:oak_log") ==
        ForeignBlock{"minecraft:oak_log", "axis=y"});
  for (const char* name :
       {"", "stone", ":", "a:", "minecraft:air", "minecraft:oak_log[axis=y]",
        "minecraft:oak_log[axis=x", "minecraft:oak_log[axis]", "minecraft:oak_log[]",
        "minecraft:oak_log{axis=x}", "minecraft:oak_log~0", "minecraft:oak_log~9",
        "minecraft:redstone_wire~", "minecraft:x#0123456789abcdef", "Mine:craft",
        "minecraft:oak_log[axis=x,axis=z]", "minecraft:two words"})
    CHECK_FALSE(block_of_minecraft_material(name).has_value());
}

TEST_CASE("names that fit no form end with a hash", "[formats]") {
  const std::string long_name = "mod:" + std::string(70, 'x');
  for (const ForeignBlock& block :
       {ForeignBlock{long_name, ""}, ForeignBlock{long_name, "a=1"},
        ForeignBlock{"mod:stone", std::string("a=\n")}, ForeignBlock{"mod:stone", "b=1,a=1"},
        ForeignBlock{"mod:stone", "a"}, ForeignBlock{"mod:stone", "a=1,"},
        ForeignBlock{"Mod:Stone", ""}, ForeignBlock{"", ""}, ForeignBlock{"\x01\xff:\n[]", ""}}) {
    const std::string name = minecraft_material_name(block);
    CAPTURE(name);
    CHECK(name.size() <= kMaterialNameBytesMax);
    REQUIRE(name.find('#') != std::string::npos);
    CHECK_FALSE(block_of_minecraft_material(name).has_value());
    MaterialTable table;
    CHECK(table.add(material_of_minecraft_block(block, true)).has_value());
  }
  CHECK(name_of(long_name) != name_of(long_name, "a=1"));
}

TEST_CASE("any bytes become a material that a table accepts", "[formats][property]") {
  SplitMix64 random{Catch::rngSeed()};
  const std::string bytes = "abc:_=,[]{}~#\n\xff 01";
  for (int i = 0; i < 3000; ++i) {
    ForeignBlock block;
    for (std::uint32_t left = random.below(90); left > 0; --left)
      block.name += bytes[random.below(static_cast<std::uint32_t>(bytes.size()))];
    for (std::uint32_t left = random.below(40); left > 0; --left)
      block.states += bytes[random.below(static_cast<std::uint32_t>(bytes.size()))];
    const bool all = random.below(2) == 1;
    const MaterialInfo info = material_of_minecraft_block(block, all);
    CAPTURE(block.name, block.states, info.name);
    MaterialTable table;
    if (info.name != "air") REQUIRE(table.add(info).has_value());
    const auto back = block_of_minecraft_material(minecraft_material_name(block));
    if (back && *back != ForeignBlock{"minecraft:air", ""})
      REQUIRE(*back == with_default_states(block));
  }
}

TEST_CASE("blocks look like what they are", "[formats]") {
  CHECK(look_at("minecraft:air").visibility == Visibility::empty);
  CHECK(look_at("minecraft:void_air").name == "air");
  CHECK(look_at("minecraft:structure_void", "", true).visibility == Visibility::empty);
  CHECK(look_at("minecraft:stone").visibility == Visibility::opaque);
  CHECK(look_at("minecraft:glass").visibility == Visibility::transparent);
  CHECK(look_at("minecraft:red_stained_glass_pane").visibility == Visibility::transparent);
  CHECK(look_at("minecraft:water", "level=3").body == MaterialBody::liquid);
  CHECK(look_at("minecraft:water").visibility == Visibility::transparent);
  CHECK(look_at("minecraft:lava").visibility == Visibility::opaque);
  CHECK(look_at("minecraft:lava").body == MaterialBody::liquid);

  SECTION("shapes have the colour of their material") {
    for (const char* shape : {"stairs", "slab", "fence", "fence_gate", "door", "trapdoor", "sign"})
      CHECK(rgb_of(std::string("minecraft:bamboo_") + shape) == rgb_of("minecraft:bamboo_planks"));
    CHECK(look_at("minecraft:stone_brick_wall").colour == look_at("minecraft:stone_bricks").colour);
    CHECK(look_at("minecraft:quartz_stairs").colour == look_at("minecraft:quartz_block").colour);
    CHECK(look_at("minecraft:oak_stairs").look->pattern == MaterialPattern::planks);
    CHECK(look_at("minecraft:short_grass").look->pattern == MaterialPattern::blades);
    CHECK(look_at("minecraft:grass_block").look->pattern == MaterialPattern::none);
    CHECK(look_at("minecraft:waxed_oxidized_cut_copper_slab").colour ==
          look_at("minecraft:oxidized_copper").colour);
  }
  SECTION("thin blocks with a shape are kept, and one walks through them") {
    for (const char* name : {"torch", "poppy", "short_grass", "oak_sapling", "rail", "lever",
                             "stone_button", "white_carpet", "oak_wall_sign", "red_banner",
                             "redstone_wire", "wall_torch", "potted_poppy", "cobweb", "ladder"}) {
      CAPTURE(name);
      const MaterialInfo kept = look_at(std::string("minecraft:") + name);
      CHECK(kept.visibility == Visibility::opaque);
      CHECK(kept.body == MaterialBody::passable);
      CHECK_FALSE(kept.shape.is_cube());
      CHECK(look_at(std::string("minecraft:") + name, "", true) == kept);
    }
  }
  SECTION("thin blocks without a shape are empty, unless all are kept") {
    CHECK(look_at("minecraft:barrier").visibility == Visibility::empty);
    const MaterialInfo kept = look_at("minecraft:barrier", "", true);
    CHECK(kept.visibility == Visibility::transparent);
    CHECK(kept.body == MaterialBody::passable);
    CHECK(kept.shape.is_cube());
  }
  SECTION("solid blocks have the shape of their states") {
    const MaterialInfo slab = look_at("minecraft:oak_slab");
    CHECK(slab.body == MaterialBody::solid);
    CHECK(slab.shape == Shape{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}});
    CHECK(look_at("minecraft:oak_slab", "type=double").shape.is_cube());
    CHECK(look_at("minecraft:stone").shape.is_cube());
    CHECK(look_at("minecraft:glass_pane").visibility == Visibility::transparent);
    CHECK_FALSE(look_at("minecraft:glass_pane").shape.is_cube());
  }
  SECTION("what stands in water becomes water") {
    CHECK(look_at("minecraft:seagrass").name == "minecraft:water");
    CHECK(look_at("minecraft:kelp", "age=3").name == "minecraft:water");
    CHECK(look_at("minecraft:tube_coral").name == "minecraft:water");
    CHECK(look_at("minecraft:tube_coral", "waterlogged=false").visibility == Visibility::opaque);
    CHECK(look_at("minecraft:ladder", "waterlogged=true").name == "minecraft:water");
    CHECK(look_at("minecraft:kelp", "", true).name == "minecraft:kelp");
  }
  SECTION("states that show") {
    CHECK(look_at("minecraft:redstone_lamp").look->emission == 0);
    CHECK(look_at("minecraft:redstone_lamp", "lit=true").look->emission > 0);
    CHECK(look_at("minecraft:glowstone").look->emission > 0);
    CHECK(look_at("minecraft:fire_coral_block").look->emission == 0);
    CHECK(look_at("minecraft:grass_block", "snowy=true").colour !=
          look_at("minecraft:grass_block").colour);
    CHECK(look_at("minecraft:oak_log", "axis=x").name != look_at("minecraft:oak_log").name);
  }
  SECTION("unknown names have a colour of their own") {
    CHECK(look_at("mod:blorb").colour == look_at("mod:blorb").colour);
    CHECK(look_at("mod:blorb").colour != look_at("mod:blarb").colour);
    CHECK(look_at("mod:blorb").visibility == Visibility::opaque);
    CHECK(look_at("mod:red_glass").visibility == Visibility::transparent);
  }
}

TEST_CASE("states are split only if they are well formed", "[formats]") {
  CHECK(split_states("")->empty());
  CHECK(split_states("a=1,b=x_2")->size() == 2);
  for (const char* states :
       {",", "a", "a=", "=1", "a=1,", "a=1,,b=2", "b=1,a=1", "a=1,a=1", "A=1", "a=1=2", "a= 1"})
    CHECK_FALSE(split_states(states).has_value());
}
