// The numbers of Minecraft's blocks before 1.13. A row says how a name and states follow from the
// bits of the data:
//   "oak_log|spruce_log@0-1 axis@2-3=y|x|z"   the name by bits 0 and 1, the axis by bits 2 and 3
//   "furnace lit=true $facing_wall"            always lit, and the words of kShared
//   "&_wool@0-3"                               the colour by bits 0 to 3
//   "age@0-3=#"                                the number itself
// A number beyond a list stands for the first word of the list.
#include <algorithm>
#include <array>
#include <optional>

#include "common/core/assert.hpp"
#include "common/formats/minecraft_blocks.hpp"

namespace runstone {
namespace {

struct NumberRow {
  std::uint16_t id;
  std::string_view block;
  std::uint8_t data_first = 0, data_last = 15;
  std::uint16_t id_last = 0;  // if given, the colour of "&" is that of the id
};

constexpr std::array<std::string_view, 16> kDyes = {
    "white",      "orange", "magenta", "light_blue", "yellow", "lime",  "pink", "gray",
    "light_gray", "cyan",   "purple",  "blue",       "brown",  "green", "red",  "black"};

struct SharedWords {
  std::string_view name, words;
};

constexpr SharedWords kShared[] = {
    {"facing", "facing@0-2=down|up|north|south|west|east"},
    {"facing_wall", "facing@0-2=north|north|north|south|west|east"},
    {"facing_turn", "facing@0-1=south|west|north|east"},
    {"facing_torch", "facing@0-2=north|east|west|south|north"},
    {"stairs", "facing@0-1=east|west|south|north half@2=bottom|top"},
    {"door_lower", "half=lower facing@0-1=east|south|west|north open@2=false|true"},
    {"door_upper", "half=upper hinge@0=left|right powered@1=false|true"},
    {"trapdoor", "facing@0-1=north|south|west|east open@2=false|true half@3=bottom|top"},
    {"gate", "facing@0-1=south|west|north|east open@2=false|true powered@3=false|true"},
    {"rail",
     "shape@0-2=north_south|east_west|ascending_east|ascending_west|ascending_north|"
     "ascending_south powered@3=false|true"},
    {"button",
     "face@0-2=ceiling|wall|wall|wall|wall|floor facing@0-2=north|east|west|south|north "
     "powered@3=false|true"},
    // The sides of a mushroom block that show its skin, by data 0 to 9.
    {"skin",
     "down=false up@0-3=false|true|true|true|true|true|true|true|true|true "
     "north@0-3=false|true|true|true "
     "south@0-3=false|false|false|false|false|false|false|true|true|true "
     "west@0-3=false|true|false|false|true|false|false|true "
     "east@0-3=false|false|false|true|false|false|true|false|false|true"},
};

/// The first row that holds an id and data counts.
constexpr NumberRow kRows[] = {
    {0, "air"},
    {1, "stone|granite|polished_granite|diorite|polished_diorite|andesite|polished_andesite@0-3"},
    {2, "grass_block"},
    {3, "dirt|coarse_dirt|podzol@0-3"},
    {4, "cobblestone"},
    {5, "oak_planks|spruce_planks|birch_planks|jungle_planks|acacia_planks|dark_oak_planks@0-3"},
    {6,
     "oak_sapling|spruce_sapling|birch_sapling|jungle_sapling|acacia_sapling|"
     "dark_oak_sapling@0-2 stage@3=0|1"},
    {7, "bedrock"},
    {8, "water level@0-3=#"},
    {9, "water level@0-3=#"},
    {10, "lava level@0-3=#"},
    {11, "lava level@0-3=#"},
    {12, "sand|red_sand@0-3"},
    {13, "gravel"},
    {14, "gold_ore"},
    {15, "iron_ore"},
    {16, "coal_ore"},
    {17, "oak_log|spruce_log|birch_log|jungle_log@0-1 axis@2-3=y|x|z", 0, 11},
    {17, "oak_wood|spruce_wood|birch_wood|jungle_wood@0-1", 12, 15},
    // 1.12 has no distance to the next log. At 7 the leaves would decay.
    {18,
     "oak_leaves|spruce_leaves|birch_leaves|jungle_leaves@0-1 persistent@2=false|true distance=1"},
    {19, "sponge|wet_sponge@0-3"},
    {20, "glass"},
    {21, "lapis_ore"},
    {22, "lapis_block"},
    {23, "dispenser $facing triggered@3=false|true"},
    {24, "sandstone|chiseled_sandstone|cut_sandstone@0-3"},
    {25, "note_block"},
    {26, "red_bed $facing_turn occupied@2=false|true part@3=foot|head"},
    {27, "powered_rail $rail"},
    {28, "detector_rail $rail"},
    {29, "sticky_piston $facing extended@3=false|true"},
    {30, "cobweb"},
    {31, "dead_bush|short_grass|fern@0-3"},
    {32, "dead_bush"},
    {33, "piston $facing extended@3=false|true"},
    {34, "piston_head $facing type@3=normal|sticky"},
    {35, "&_wool@0-3"},
    {36, "moving_piston $facing type@3=normal|sticky"},
    {37, "dandelion"},
    {38,
     "poppy|blue_orchid|allium|azure_bluet|red_tulip|orange_tulip|white_tulip|pink_tulip|"
     "oxeye_daisy@0-3"},
    {39, "brown_mushroom"},
    {40, "red_mushroom"},
    {41, "gold_block"},
    {42, "iron_block"},
    {43,
     "smooth_stone_slab|sandstone_slab|petrified_oak_slab|cobblestone_slab|brick_slab|"
     "stone_brick_slab|nether_brick_slab|quartz_slab@0-2 type=double",
     0, 7},
    {43,
     "smooth_stone|smooth_sandstone|petrified_oak_slab|cobblestone_slab|brick_slab|"
     "stone_brick_slab|nether_brick_slab|smooth_quartz@0-2",
     8, 9},
    {43,
     "smooth_stone_slab|sandstone_slab|petrified_oak_slab|cobblestone_slab|brick_slab|"
     "stone_brick_slab|nether_brick_slab@0-2 type=double",
     10, 14},
    {43, "smooth_quartz"},
    {44,
     "smooth_stone_slab|sandstone_slab|petrified_oak_slab|cobblestone_slab|brick_slab|"
     "stone_brick_slab|nether_brick_slab|quartz_slab@0-2 type@3=bottom|top"},
    {45, "bricks"},
    {46, "tnt unstable@0=false|true"},
    {47, "bookshelf"},
    {48, "mossy_cobblestone"},
    {49, "obsidian"},
    {50, "wall_torch $facing_torch", 1, 4},
    {50, "torch"},
    {51, "fire age@0-3=#"},
    {52, "spawner"},
    {53, "oak_stairs $stairs"},
    {54, "chest $facing_wall"},
    {55, "redstone_wire power@0-3=#"},
    {56, "diamond_ore"},
    {57, "diamond_block"},
    {58, "crafting_table"},
    {59, "wheat age@0-2=0|1|2|3|4|5|6|7"},
    {60, "farmland moisture@0-2=0|1|2|3|4|5|6|7"},
    {61, "furnace $facing_wall"},
    {62, "furnace lit=true $facing_wall"},
    {63, "oak_sign rotation@0-3=#"},
    {64, "oak_door $door_lower", 0, 7},
    {64, "oak_door $door_upper"},
    {65, "ladder $facing_wall"},
    {66,
     "rail shape@0-3=north_south|east_west|ascending_east|ascending_west|ascending_north|"
     "ascending_south|south_east|south_west|north_west|north_east"},
    {67, "cobblestone_stairs $stairs"},
    {68, "oak_wall_sign $facing_wall"},
    {69,
     "lever face@0-2=ceiling|wall|wall|wall|wall|floor|floor|ceiling facing@0-2=west|east|west|"
     "south|north|north|west|north powered@3=false|true"},
    {70, "stone_pressure_plate powered@0=false|true"},
    {71, "iron_door $door_lower", 0, 7},
    {71, "iron_door $door_upper"},
    {72, "oak_pressure_plate powered@0=false|true"},
    {73, "redstone_ore"},
    {74, "redstone_ore lit=true"},
    {75, "redstone_wall_torch lit=false $facing_torch", 1, 4},
    {75, "redstone_torch lit=false"},
    {76, "redstone_wall_torch $facing_torch", 1, 4},
    {76, "redstone_torch"},
    {77, "stone_button $button"},
    {78, "snow layers@0-2=1|2|3|4|5|6|7|8"},
    {79, "ice"},
    {80, "snow_block"},
    {81, "cactus age@0-3=#"},
    {82, "clay"},
    {83, "sugar_cane age@0-3=#"},
    {84, "jukebox has_record@0=false|true"},
    {85, "oak_fence"},
    {86, "carved_pumpkin $facing_turn"},
    {87, "netherrack"},
    {88, "soul_sand"},
    {89, "glowstone"},
    {90, "nether_portal axis@0-1=x|x|z"},
    {91, "jack_o_lantern $facing_turn"},
    {92, "cake bites@0-2=0|1|2|3|4|5|6"},
    {93, "repeater $facing_turn delay@2-3=1|2|3|4"},
    {94, "repeater powered=true $facing_turn delay@2-3=1|2|3|4"},
    {95, "&_stained_glass@0-3"},
    {96, "oak_trapdoor $trapdoor"},
    {97,
     "infested_stone|infested_cobblestone|infested_stone_bricks|infested_mossy_stone_bricks|"
     "infested_cracked_stone_bricks|infested_chiseled_stone_bricks@0-3"},
    {98, "stone_bricks|mossy_stone_bricks|cracked_stone_bricks|chiseled_stone_bricks@0-3"},
    {99, "brown_mushroom_block $skin", 0, 9},
    {99, "mushroom_stem down=false up=false", 10, 10},
    {99, "mushroom_stem", 15, 15},
    {99, "brown_mushroom_block"},
    {100, "red_mushroom_block $skin", 0, 9},
    {100, "mushroom_stem down=false up=false", 10, 10},
    {100, "mushroom_stem", 15, 15},
    {100, "red_mushroom_block"},
    {101, "iron_bars"},
    {102, "glass_pane"},
    {103, "melon"},
    {104, "pumpkin_stem age@0-2=0|1|2|3|4|5|6|7"},
    {105, "melon_stem age@0-2=0|1|2|3|4|5|6|7"},
    {106, "vine south@0=false|true west@1=false|true north@2=false|true east@3=false|true"},
    {107, "oak_fence_gate $gate"},
    {108, "brick_stairs $stairs"},
    {109, "stone_brick_stairs $stairs"},
    {110, "mycelium"},
    {111, "lily_pad"},
    {112, "nether_bricks"},
    {113, "nether_brick_fence"},
    {114, "nether_brick_stairs $stairs"},
    {115, "nether_wart age@0-1=0|1|2|3"},
    {116, "enchanting_table"},
    {117,
     "brewing_stand has_bottle_0@0=false|true has_bottle_1@1=false|true has_bottle_2@2=false|true"},
    {118, "cauldron", 0, 0},
    {118, "water_cauldron level@0-1=1|1|2|3"},
    {119, "end_portal"},
    {120, "end_portal_frame $facing_turn eye@2=false|true"},
    {121, "end_stone"},
    {122, "dragon_egg"},
    {123, "redstone_lamp"},
    {124, "redstone_lamp lit=true"},
    {125, "oak_slab|spruce_slab|birch_slab|jungle_slab|acacia_slab|dark_oak_slab@0-2 type=double"},
    {126,
     "oak_slab|spruce_slab|birch_slab|jungle_slab|acacia_slab|dark_oak_slab@0-2 type@3=bottom|top"},
    {127, "cocoa $facing_turn age@2-3=0|1|2"},
    {128, "sandstone_stairs $stairs"},
    {129, "emerald_ore"},
    {130, "ender_chest $facing_wall"},
    {131, "tripwire_hook $facing_turn attached@2=false|true powered@3=false|true"},
    {132, "tripwire powered@0=false|true attached@2=false|true disarmed@3=false|true"},
    {133, "emerald_block"},
    {134, "spruce_stairs $stairs"},
    {135, "birch_stairs $stairs"},
    {136, "jungle_stairs $stairs"},
    {137, "command_block $facing conditional@3=false|true"},
    {138, "beacon"},
    {139, "cobblestone_wall|mossy_cobblestone_wall@0-3"},
    {140,
     "flower_pot|potted_poppy|potted_dandelion|potted_oak_sapling|potted_spruce_sapling|"
     "potted_birch_sapling|potted_jungle_sapling|potted_red_mushroom|potted_brown_mushroom|"
     "potted_cactus|potted_dead_bush|potted_fern|potted_acacia_sapling|"
     "potted_dark_oak_sapling@0-3"},
    {141, "carrots age@0-2=0|1|2|3|4|5|6|7"},
    {142, "potatoes age@0-2=0|1|2|3|4|5|6|7"},
    {143, "oak_button $button"},
    {144, "skeleton_wall_skull $facing_wall", 2, 5},
    {144, "skeleton_wall_skull $facing_wall", 10, 13},
    {144, "skeleton_skull"},
    {145, "anvil|chipped_anvil|damaged_anvil@2-3 $facing_turn"},
    {146, "trapped_chest $facing_wall"},
    {147, "light_weighted_pressure_plate power@0-3=#"},
    {148, "heavy_weighted_pressure_plate power@0-3=#"},
    {149, "comparator $facing_turn mode@2=compare|subtract powered@3=false|true"},
    {150, "comparator powered=true $facing_turn mode@2=compare|subtract"},
    {151, "daylight_detector power@0-3=#"},
    {152, "redstone_block"},
    {153, "nether_quartz_ore"},
    {154, "hopper facing@0-2=down|down|north|south|west|east enabled@3=true|false"},
    {155, "quartz_pillar axis@0-2=y|y|y|x|z", 2, 4},
    {155, "quartz_pillar axis@2-3=y|x|z", 6, 10},
    {155, "quartz_block|chiseled_quartz_block@0-3"},
    {156, "quartz_stairs $stairs"},
    {157, "activator_rail $rail"},
    {158, "dropper $facing triggered@3=false|true"},
    {159, "&_terracotta@0-3"},
    {160, "&_stained_glass_pane@0-3"},
    {161, "acacia_leaves|dark_oak_leaves@0-1 persistent@2=false|true distance=1"},
    {162, "acacia_log|dark_oak_log@0-1 axis@2-3=y|x|z", 0, 11},
    {162, "acacia_wood|dark_oak_wood@0-1"},
    {163, "acacia_stairs $stairs"},
    {164, "dark_oak_stairs $stairs"},
    {165, "slime_block"},
    {166, "barrier"},
    {167, "iron_trapdoor $trapdoor"},
    {168, "prismarine|prismarine_bricks|dark_prismarine@0-3"},
    {169, "sea_lantern"},
    {170, "hay_block axis@2-3=y|x|z"},
    {171, "&_carpet@0-3"},
    {172, "terracotta"},
    {173, "coal_block"},
    {174, "packed_ice"},
    {175, "sunflower|lilac|tall_grass|large_fern|rose_bush|peony@0-2", 0, 7},
    // The upper half does not know its plant. Most are grass.
    {175, "tall_grass half=upper"},
    {176, "white_banner rotation@0-3=#"},
    {177, "white_wall_banner $facing_wall"},
    {178, "daylight_detector inverted=true power@0-3=#"},
    {179, "red_sandstone|chiseled_red_sandstone|cut_red_sandstone@0-3"},
    {180, "red_sandstone_stairs $stairs"},
    {181, "smooth_red_sandstone", 8, 8},
    {181, "red_sandstone_slab type=double"},
    {182, "red_sandstone_slab type@3=bottom|top"},
    {183, "spruce_fence_gate $gate"},
    {184, "birch_fence_gate $gate"},
    {185, "jungle_fence_gate $gate"},
    {186, "dark_oak_fence_gate $gate"},
    {187, "acacia_fence_gate $gate"},
    {188, "spruce_fence"},
    {189, "birch_fence"},
    {190, "jungle_fence"},
    {191, "dark_oak_fence"},
    {192, "acacia_fence"},
    {193, "spruce_door $door_lower", 0, 7},
    {193, "spruce_door $door_upper"},
    {194, "birch_door $door_lower", 0, 7},
    {194, "birch_door $door_upper"},
    {195, "jungle_door $door_lower", 0, 7},
    {195, "jungle_door $door_upper"},
    {196, "acacia_door $door_lower", 0, 7},
    {196, "acacia_door $door_upper"},
    {197, "dark_oak_door $door_lower", 0, 7},
    {197, "dark_oak_door $door_upper"},
    {198, "end_rod $facing"},
    {199, "chorus_plant"},
    {200, "chorus_flower age@0-2=0|1|2|3|4|5"},
    {201, "purpur_block"},
    {202, "purpur_pillar axis@2-3=y|x|z"},
    {203, "purpur_stairs $stairs"},
    {204, "purpur_slab type=double"},
    {205, "purpur_slab type@3=bottom|top"},
    {206, "end_stone_bricks"},
    {207, "beetroots age@0-1=0|1|2|3"},
    {208, "dirt_path"},
    {209, "end_gateway"},
    {210, "repeating_command_block $facing conditional@3=false|true"},
    {211, "chain_command_block $facing conditional@3=false|true"},
    {212, "frosted_ice age@0-1=0|1|2|3"},
    {213, "magma_block"},
    {214, "nether_wart_block"},
    {215, "red_nether_bricks"},
    {216, "bone_block axis@2-3=y|x|z"},
    {217, "structure_void"},
    {218, "observer $facing powered@3=false|true"},
    {219, "&_shulker_box $facing", 0, 15, 234},
    {235, "&_glazed_terracotta $facing_turn", 0, 15, 250},
    {251, "&_concrete@0-3"},
    {252, "&_concrete_powder@0-3"},
    {255, "structure_block mode@0-1=save|load|corner|data"},
};

/// Takes the next word of a text.
std::string_view take_word(std::string_view& text, char end) {
  const std::size_t at = std::min(text.find(end), text.size());
  const std::string_view word = text.substr(0, at);
  text.remove_prefix(std::min(at + 1, text.size()));
  return word;
}

/// Takes "@2-3" or "@2" from the end of a text. Returns the number that these bits of `data` hold,
/// or nullopt if the text names no bits.
std::optional<unsigned> take_bits(std::string_view& text, unsigned data) {
  const std::size_t at = text.find('@');
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view bits = text.substr(at + 1);
  text = text.substr(0, at);
  const unsigned first = static_cast<unsigned>(bits.front() - '0');
  const unsigned last = static_cast<unsigned>(bits.back() - '0');
  return data >> first & ((1U << (last - first + 1)) - 1);
}

std::string_view choose(std::string_view list, unsigned index) {
  std::string_view rest = list;
  for (unsigned i = 0; !rest.empty(); ++i) {
    const std::string_view word = take_word(rest, '|');
    if (i == index) return word;
  }
  return take_word(list, '|');
}

void add_states(std::string_view words, unsigned data,
                std::vector<std::pair<std::string, std::string>>& out) {
  while (!words.empty()) {
    std::string_view word = take_word(words, ' ');
    if (word.front() == '$') {
      const auto* shared = std::find_if(std::begin(kShared), std::end(kShared),
                                        [&](const auto& s) { return s.name == word.substr(1); });
      RUNSTONE_ASSERT(shared != std::end(kShared));
      // A text of kShared names no other one.
      add_states(shared->words, data, out);
      continue;
    }
    const std::string_view list = word.substr(word.find('=') + 1);
    std::string_view key = word.substr(0, word.find('='));
    const unsigned index = take_bits(key, data).value_or(0);
    out.emplace_back(key, list == "#" ? std::to_string(index) : std::string(choose(list, index)));
  }
}

}  // namespace

std::optional<ForeignBlock> minecraft_block_of(std::uint16_t id, std::uint8_t data) {
  if (data > 15) return std::nullopt;
  const auto* row = std::find_if(std::begin(kRows), std::end(kRows), [&](const NumberRow& r) {
    return id >= r.id && id <= std::max(r.id, r.id_last) && data >= r.data_first &&
           data <= r.data_last;
  });
  if (row == std::end(kRows)) return std::nullopt;
  std::string_view words = row->block;
  std::string_view names = take_word(words, ' ');
  const auto index = take_bits(names, data);
  std::string name = "minecraft:";
  if (names.front() == '&') {
    name += kDyes[index.value_or(static_cast<unsigned>(id - row->id))];
    name += names.substr(1);
  } else {
    name += choose(names, index.value_or(0));
  }
  std::vector<std::pair<std::string, std::string>> states;
  add_states(words, data, states);
  std::sort(states.begin(), states.end());
  ForeignBlock block{std::move(name), ""};
  for (const auto& [key, value] : states) {
    if (!block.states.empty()) block.states += ',';
    block.states.append(key).append("=").append(value);
  }
  return with_default_states(block);
}

}  // namespace runstone
