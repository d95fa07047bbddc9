// Colours of Minecraft's blocks. Common blocks, metals, woods and dyes have colours that were chosen
// by hand. The others are composed by the words of their names: a shape ("_stairs") has the colour
// of its material, a kind of wood that of its planks, bark or leaves, a dyed thing that of its dye,
// an ore that of metal and stone. No art of the game is used: a block is one flat colour.
#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "common/core/hash.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_states.hpp"
#include "common/formats/shape_names.hpp"
#include "common/materials/default_look.hpp"

namespace runstone {
namespace {

enum class Form : std::uint8_t {
  solid,  // a whole cube
  clear,  // glass, ice and the like
  thin,   // plants, torches, rails: no cube, so empty unless requested
  wet,    // thin, and always in water
  liquid,
  air,
};

struct Appearance {
  std::uint32_t rgb = 0;
  Form form = Form::solid;
  std::uint8_t alpha = 255;  // of what is clear or liquid
};

struct NamedAppearance {
  std::string_view name;
  Appearance appearance;
};

constexpr Appearance kWater{0x2f6fb0, Form::liquid, 168};

/// Blocks by name. The shapes and the kinds of wood, dye, ore and copper that follow are composed of
/// these and of the tables below.
constexpr NamedAppearance kBlocks[] = {
    {"air", {0, Form::air}},
    {"cave_air", {0, Form::air}},
    {"void_air", {0, Form::air}},
    {"structure_void", {0, Form::air}},
    {"barrier", {0xc83c3c, Form::thin}},
    {"light", {0xfff2b0, Form::thin}},
    {"moving_piston", {0x8d8470, Form::thin}},
    {"water", kWater},
    {"lava", {0xe8651c, Form::liquid}},
    {"bubble_column", {0x3b7fbd, Form::wet}},
    // Earth and stone.
    {"stone", {0x7e7e7e}},
    {"smooth_stone", {0x9d9d9d}},
    {"granite", {0x976a58}},
    {"polished_granite", {0x9b6b5a}},
    {"diorite", {0xbcbcbd}},
    {"polished_diorite", {0xc2c2c4}},
    {"andesite", {0x888888}},
    {"polished_andesite", {0x848785}},
    {"cobblestone", {0x7a7a7a}},
    {"mossy_cobblestone", {0x6d7a5c}},
    {"stone_bricks", {0x7a797a}},
    {"mossy_stone_bricks", {0x717a67}},
    {"bricks", {0x97604f}},
    {"bedrock", {0x545454}},
    {"grass_block", {0x6f9f46}},
    {"dirt", {0x866043}},
    {"coarse_dirt", {0x77553b}},
    {"rooted_dirt", {0x90684d}},
    {"dirt_path", {0x94793f}},
    {"grass_path", {0x94793f}},
    {"podzol", {0x6a4a23}},
    {"mycelium", {0x6f6365}},
    {"farmland", {0x6f4a2c}},
    {"mud", {0x3c3a3d}},
    {"packed_mud", {0x8d6a4f}},
    {"mud_bricks", {0x89684f}},
    {"clay", {0xa0a6b3}},
    {"sand", {0xdbcfa3}},
    {"red_sand", {0xbe6621}},
    {"suspicious_sand", {0xd8ca9c}},
    {"gravel", {0x837f7e}},
    {"suspicious_gravel", {0x817d7b}},
    {"sandstone", {0xd8cb9b}},
    {"red_sandstone", {0xb5621f}},
    {"snow", {0xf6fbfb}},
    {"snow_block", {0xf8fdfd}},
    {"powder_snow", {0xf7fcfc}},
    {"ice", {0x91b7fd, Form::clear, 190}},
    {"frosted_ice", {0x8cb4fc, Form::clear, 190}},
    {"packed_ice", {0x8db4fa}},
    {"blue_ice", {0x74a7fd}},
    {"obsidian", {0x0f0b19}},
    {"crying_obsidian", {0x200a3c}},
    {"deepslate", {0x505053}},
    {"cobbled_deepslate", {0x4d4d50}},
    {"polished_deepslate", {0x48494a}},
    {"deepslate_bricks", {0x464647}},
    {"deepslate_tiles", {0x363737}},
    {"reinforced_deepslate", {0x50534f}},
    {"tuff", {0x6c6d66}},
    {"polished_tuff", {0x616963}},
    {"tuff_bricks", {0x62675f}},
    {"calcite", {0xdfe0dc}},
    {"dripstone_block", {0x866b5c}},
    {"pointed_dripstone", {0x816659}},
    {"basalt", {0x50515a}},
    {"polished_basalt", {0x5c5c60}},
    {"smooth_basalt", {0x48484e}},
    {"blackstone", {0x2b2429}},
    {"polished_blackstone", {0x353039}},
    {"polished_blackstone_bricks", {0x302a31}},
    {"gilded_blackstone", {0x3a2e29}},
    {"magma_block", {0x8e3f1f}},
    {"moss_block", {0x596d2d}},
    {"pale_moss_block", {0x6b7069}},
    {"sculk", {0x0d1e24}},
    {"sculk_catalyst", {0x16303a}},
    {"sculk_sensor", {0x0b4a57}},
    {"calibrated_sculk_sensor", {0x1d4c68}},
    {"sculk_shrieker", {0xc0c5a0}},
    {"sculk_vein", {0x0a333b, Form::thin}},
    // Nether and End.
    {"netherrack", {0x622626}},
    {"nether_bricks", {0x2c161a}},
    {"red_nether_bricks", {0x460709}},
    {"soul_sand", {0x513e33}},
    {"soul_soil", {0x4c3a2f}},
    {"glowstone", {0xcfa468}},
    {"crimson_nylium", {0x831f1f}},
    {"warped_nylium", {0x2b7265}},
    {"nether_wart_block", {0x730302}},
    {"warped_wart_block", {0x177879}},
    {"shroomlight", {0xf19346}},
    {"ancient_debris", {0x60413a}},
    {"nether_portal", {0x6a1fc4, Form::clear, 160}},
    {"end_stone", {0xdcdf9f}},
    {"end_stone_bricks", {0xdae1a3}},
    {"end_portal", {0x0a1418, Form::clear, 230}},
    {"end_gateway", {0x0a1418, Form::clear, 230}},
    {"end_portal_frame", {0x5b7962}},
    {"end_rod", {0xece0d2, Form::thin}},
    {"purpur_block", {0xa97da9}},
    {"purpur_pillar", {0xab80ab}},
    {"chorus_plant", {0x5e395e}},
    {"chorus_flower", {0x977a97}},
    {"dragon_egg", {0x0d090f}},
    // Metals, minerals and what is made of them.
    {"coal_block", {0x101010}},
    {"iron_block", {0xdcdcdc}},
    {"gold_block", {0xf6d03d}},
    {"diamond_block", {0x62ede4}},
    {"emerald_block", {0x2acb57}},
    {"lapis_block", {0x1e438c}},
    {"redstone_block", {0xaf1805}},
    {"netherite_block", {0x423d3f}},
    {"quartz_block", {0xebe5de}},
    {"quartz_pillar", {0xebe6e0}},
    {"quartz_bricks", {0xeae5dd}},
    {"raw_iron_block", {0xa6876b}},
    {"raw_copper_block", {0x9a694f}},
    {"raw_gold_block", {0xdda92e}},
    {"amethyst_block", {0x8561bf}},
    {"budding_amethyst", {0x8460bb}},
    {"amethyst_cluster", {0xa37ecf, Form::thin}},
    {"prismarine", {0x639c97}},
    {"prismarine_bricks", {0x63ac9e}},
    {"dark_prismarine", {0x335b4b}},
    {"sea_lantern", {0xacc7be}},
    {"bone_block", {0xe0dcc6}},
    {"terracotta", {0x985e43}},
    {"honeycomb_block", {0xe5941d}},
    {"honey_block", {0xfbb934, Form::clear, 200}},
    {"slime_block", {0x6fc05b, Form::clear, 190}},
    {"resin_block", {0xd9641a}},
    {"resin_bricks", {0xcd5819}},
    {"resin_clump", {0xd9641a, Form::thin}},
    {"sponge", {0xc3c04a}},
    {"wet_sponge", {0xabb546}},
    {"glass", {0xd3e9f0, Form::clear, 72}},
    {"tinted_glass", {0x2c262d, Form::clear, 190}},
    {"iron_bars", {0x888b87, Form::clear, 170}},
    {"cobweb", {0xe4e9ea, Form::thin}},
    // Plants that fill their block.
    {"hay_block", {0xa68b26}},
    {"melon", {0x6f9020}},
    {"pumpkin", {0xc47218}},
    {"carved_pumpkin", {0xbd6c17}},
    {"jack_o_lantern", {0xd8942c}},
    {"cactus", {0x557f2b}},
    {"brown_mushroom_block", {0x957051}},
    {"red_mushroom_block", {0xc82f2d}},
    {"mushroom_stem", {0xcbc4b9}},
    {"dried_kelp_block", {0x323b27}},
    {"azalea", {0x667d30, Form::thin}},
    {"flowering_azalea", {0x70774a, Form::thin}},
    {"azalea_leaves", {0x5a732c}},
    {"flowering_azalea_leaves", {0x636f3d}},
    {"mangrove_roots", {0x4b3c26}},
    {"muddy_mangrove_roots", {0x463b2d}},
    {"bamboo", {0x5d9013, Form::thin}},
    {"bee_nest", {0xc9a44f}},
    {"beehive", {0xb4925a}},
    {"ochre_froglight", {0xfbf5ce}},
    {"verdant_froglight", {0xe5f4e4}},
    {"pearlescent_froglight", {0xf5f0ef}},
    {"sea_pickle", {0x5a6128, Form::wet}},
    {"turtle_egg", {0xe4e3bf, Form::thin}},
    {"sniffer_egg", {0x8a5f44}},
    {"dried_ghast", {0xb9a59f}},
    // Plants that are thin. The words below know more of them.
    {"short_grass", {0x74a64a, Form::thin}},
    {"grass", {0x74a64a, Form::thin}},
    {"tall_grass", {0x6fa046, Form::thin}},
    {"fern", {0x5f9440, Form::thin}},
    {"large_fern", {0x5a8f3d, Form::thin}},
    {"dead_bush", {0x6b4f29, Form::thin}},
    {"bush", {0x6f9c4d, Form::thin}},
    {"firefly_bush", {0x6a7d4a, Form::thin}},
    {"short_dry_grass", {0xb9a05d, Form::thin}},
    {"tall_dry_grass", {0xb9a05d, Form::thin}},
    {"leaf_litter", {0x8a5a33, Form::thin}},
    {"seagrass", {0x337f08, Form::wet}},
    {"tall_seagrass", {0x337f08, Form::wet}},
    {"kelp", {0x578c2d, Form::wet}},
    {"kelp_plant", {0x568a2c, Form::wet}},
    {"dandelion", {0xf0d43a, Form::thin}},
    {"poppy", {0xd02f26, Form::thin}},
    {"blue_orchid", {0x2f9fd8, Form::thin}},
    {"allium", {0xa877d0, Form::thin}},
    {"azure_bluet", {0xd8dfd2, Form::thin}},
    {"oxeye_daisy", {0xdfe2d8, Form::thin}},
    {"cornflower", {0x4f77c9, Form::thin}},
    {"lily_of_the_valley", {0xe3ebe0, Form::thin}},
    {"wither_rose", {0x2a2620, Form::thin}},
    {"sunflower", {0xf2c12e, Form::thin}},
    {"lilac", {0xb98fb6, Form::thin}},
    {"rose_bush", {0x9a3328, Form::thin}},
    {"peony", {0xd1a9cc, Form::thin}},
    {"torchflower", {0xe07a35, Form::thin}},
    {"pitcher_plant", {0x7a86b8, Form::thin}},
    {"spore_blossom", {0xcf619f, Form::thin}},
    {"pink_petals", {0xf2a8d0, Form::thin}},
    {"wildflowers", {0xe9cf5a, Form::thin}},
    {"cactus_flower", {0xd984a0, Form::thin}},
    {"open_eyeblossom", {0xd97b32, Form::thin}},
    {"closed_eyeblossom", {0x76737a, Form::thin}},
    {"lily_pad", {0x2b6d24, Form::thin}},
    {"frogspawn", {0x6a5a52, Form::thin}},
    {"vine", {0x4f7a2f, Form::thin}},
    {"glow_lichen", {0x708279, Form::thin}},
    {"hanging_roots", {0xa1735c, Form::thin}},
    {"pale_hanging_moss", {0x6b7069, Form::thin}},
    {"sugar_cane", {0x94c065, Form::thin}},
    {"sweet_berry_bush", {0x395b38, Form::thin}},
    {"cocoa", {0x8b5a2d, Form::thin}},
    {"wheat", {0xa7972f, Form::thin}},
    {"carrots", {0x4f8b2a, Form::thin}},
    {"potatoes", {0x559a35, Form::thin}},
    {"beetroots", {0x5d7736, Form::thin}},
    {"nether_wart", {0x751712, Form::thin}},
    {"pumpkin_stem", {0x7f8c3c, Form::thin}},
    {"melon_stem", {0x7f8c3c, Form::thin}},
    {"attached_pumpkin_stem", {0x8b8233, Form::thin}},
    {"attached_melon_stem", {0x8b8233, Form::thin}},
    {"pitcher_crop", {0x6e8a6a, Form::thin}},
    {"torchflower_crop", {0x6f9a4a, Form::thin}},
    {"warped_fungus", {0x4a6d57, Form::thin}},
    {"crimson_fungus", {0x8d2c1e, Form::thin}},
    {"warped_roots", {0x148a7c, Form::thin}},
    {"crimson_roots", {0x7e082a, Form::thin}},
    {"nether_sprouts", {0x13978a, Form::thin}},
    {"brown_mushroom", {0x9a755c, Form::thin}},
    {"red_mushroom", {0xd84b43, Form::thin}},
    {"small_dripleaf", {0x5f7a32, Form::thin}},
    {"big_dripleaf", {0x708e33, Form::thin}},
    {"big_dripleaf_stem", {0x5c7530, Form::thin}},
    // Light, fire and redstone.
    {"torch", {0xffd27a, Form::thin}},
    {"soul_torch", {0x7ce0e0, Form::thin}},
    {"copper_torch", {0x9fe08a, Form::thin}},
    {"redstone_torch", {0xd63a22, Form::thin}},
    {"lantern", {0xd9a45a, Form::thin}},
    {"soul_lantern", {0x7cc4c4, Form::thin}},
    {"copper_lantern", {0xbf8a5a, Form::thin}},
    {"fire", {0xf49a33, Form::thin}},
    {"soul_fire", {0x33c5ca, Form::thin}},
    {"campfire", {0x8a5a2c}},
    {"soul_campfire", {0x5a6f66}},
    {"candle", {0xe8cfa2, Form::thin}},
    {"candle_cake", {0xf0dfd6}},
    {"redstone_wire", {0x9a1208, Form::thin}},
    {"redstone_lamp", {0x5f3a20}},
    {"repeater", {0xa09b98, Form::thin}},
    {"comparator", {0xa29d9b, Form::thin}},
    {"lever", {0x6f6046, Form::thin}},
    {"tripwire", {0xb5b5b5, Form::thin}},
    {"tripwire_hook", {0x8a7a5e, Form::thin}},
    {"rail", {0x7d6f58, Form::thin}},
    {"powered_rail", {0x8a6d4a, Form::thin}},
    {"detector_rail", {0x7a6855, Form::thin}},
    {"activator_rail", {0x735748, Form::thin}},
    {"light_weighted_pressure_plate", {0xf6d03d, Form::thin}},
    {"heavy_weighted_pressure_plate", {0xdcdcdc, Form::thin}},
    {"piston", {0x9a7f56}},
    {"sticky_piston", {0x8d8a58}},
    {"piston_head", {0x9a7f56}},
    {"observer", {0x666565}},
    {"dispenser", {0x757575}},
    {"dropper", {0x757575}},
    {"hopper", {0x4c4a4c}},
    {"crafter", {0x706363}},
    {"target", {0xe4b1a3}},
    {"note_block", {0x593b29}},
    {"jukebox", {0x5e4130}},
    {"daylight_detector", {0x827460}},
    {"tnt", {0xb5452f}},
    {"lightning_rod", {0xc16b4f, Form::thin}},
    {"beacon", {0x76ddd7, Form::clear, 220}},
    {"conduit", {0xa08c71, Form::thin}},
    {"respawn_anchor", {0x2a1840}},
    {"lodestone", {0x77787b}},
    {"heavy_core", {0x52565c}},
    // Furniture and tools.
    {"crafting_table", {0x7c5b35}},
    {"fletching_table", {0xbda56b}},
    {"smithing_table", {0x3a3b46}},
    {"cartography_table", {0x69553f}},
    {"enchanting_table", {0x5c3536}},
    {"loom", {0x8f775c}},
    {"stonecutter", {0x7c756f}},
    {"grindstone", {0x8c8c8c}},
    {"lectern", {0xa98a56}},
    {"composter", {0x76492b}},
    {"barrel", {0x87653b}},
    {"chest", {0x8f6428}},
    {"trapped_chest", {0x8f6428}},
    {"ender_chest", {0x2b3a3d}},
    {"shulker_box", {0x8e608d}},
    {"bookshelf", {0x7a5e3d}},
    {"chiseled_bookshelf", {0xb1905a}},
    {"furnace", {0x6e6e6e}},
    {"blast_furnace", {0x6b6a6b}},
    {"smoker", {0x665c4e}},
    {"cauldron", {0x4a494a}},
    {"brewing_stand", {0x7a6a53}},
    {"anvil", {0x444444}},
    {"bell", {0xfcd742}},
    {"decorated_pot", {0x8a4a35}},
    {"flower_pot", {0x7c4535, Form::thin}},
    {"ladder", {0x7d6138, Form::thin}},
    {"sign", {0xa2834f, Form::thin}},
    {"scaffolding", {0xaa834a}},
    {"chain", {0x333a4a, Form::thin}},
    {"iron_chain", {0x333a4a, Form::thin}},
    {"cake", {0xf0dfd6}},
    {"spawner", {0x243040, Form::clear, 200}},
    {"trial_spawner", {0x2f3d45}},
    {"vault", {0x38454c}},
    {"creaking_heart", {0x6a5a55}},
    {"command_block", {0xb5886c}},
    {"repeating_command_block", {0x8170b0}},
    {"chain_command_block", {0x85a596}},
    {"structure_block", {0x594a5a}},
    {"test_block", {0x8a8f96}},
    {"test_instance_block", {0x8a8f96}},
    {"jigsaw", {0x504650}},
    {"skeleton_skull", {0xbdbdbd, Form::thin}},
    {"wither_skeleton_skull", {0x262626, Form::thin}},
    {"zombie_head", {0x3f6b30, Form::thin}},
    {"player_head", {0xa57a5e, Form::thin}},
    {"creeper_head", {0x58a350, Form::thin}},
    {"dragon_head", {0x241f24, Form::thin}},
    {"piglin_head", {0xd69c84, Form::thin}},
};

/// Colours by the dye.
constexpr NamedAppearance kDyes16[] = {
    {"light_blue", {0x3ab3da}}, {"light_gray", {0x9d9d97}}, {"white", {0xf2f4f4}},
    {"orange", {0xf07613}},     {"magenta", {0xbd44b3}},    {"yellow", {0xf8c627}},
    {"lime", {0x70b919}},       {"pink", {0xed8dac}},       {"gray", {0x3e4447}},
    {"cyan", {0x158991}},       {"purple", {0x792aac}},     {"blue", {0x35399d}},
    {"brown", {0x724728}},      {"green", {0x546d1b}},      {"red", {0xa12722}},
    {"black", {0x141519}},
};

/// A kind of dyed block: the share of the dye's colour, in percent, and the colour of the rest.
struct DyedKind {
  std::string_view name;
  std::uint32_t rest;
  int dye_percent;
  Form form = Form::solid;
  std::uint8_t alpha = 255;
};
constexpr DyedKind kDyed[] = {
    {"wool", 0, 100},
    {"carpet", 0, 100, Form::thin},
    {"concrete", 0x101010, 88},
    {"concrete_powder", 0xe8e8e8, 80},
    {"terracotta", 0x985e43, 42},
    {"glazed_terracotta", 0xe6e2d2, 82},
    {"stained_glass", 0xffffff, 92, Form::clear, 120},
    {"stained_glass_pane", 0xffffff, 92, Form::clear, 130},
    {"shulker_box", 0x8a6a8a, 85},
    {"bed", 0x9a7a50, 82},
    {"banner", 0, 100, Form::thin},
    {"wall_banner", 0, 100, Form::thin},
    {"candle", 0xe8cfa2, 75, Form::thin},
    {"candle_cake", 0xf0dfd6, 25},
    {"tulip", 0x5f8f40, 75, Form::thin},
};

/// The colours of a kind of wood.
struct Wood {
  std::string_view name;
  std::uint32_t planks, bark, stripped, leaves;
};
constexpr Wood kWoods[] = {
    {"dark_oak", 0x432b14, 0x3c2f1a, 0x604c31, 0x4a7a2c},
    {"pale_oak", 0xe4dad8, 0x584d4b, 0xf5eeed, 0x747a70},
    {"oak", 0xa2834f, 0x6d5533, 0xb1905a, 0x4f8a2f},
    {"spruce", 0x735531, 0x3b2611, 0x745a35, 0x3f6340},
    {"birch", 0xc0af79, 0xd8d7d2, 0xc5b178, 0x6c9148},
    {"jungle", 0xa07351, 0x554420, 0xab8553, 0x3f8f1e},
    {"acacia", 0xa85a32, 0x676157, 0xaf5d3c, 0x6f9a2f},
    {"mangrove", 0x763631, 0x544329, 0x7a3730, 0x5a8f2c},
    {"cherry", 0xe3b3ad, 0x37212c, 0xd8929a, 0xe5adc3},
    {"bamboo", 0xc1ad50, 0x7f903a, 0xc2af53, 0x6a9a30},
    {"crimson", 0x653147, 0x5c191d, 0x8a3a5b, 0x730302},
    {"warped", 0x2b6963, 0x3a3a4e, 0x3a9795, 0x177879},
};

/// The colours of a metal or mineral in an ore.
constexpr NamedAppearance kOres[] = {
    {"coal", {0x2a2a2a}},  {"iron", {0xd0aa8c}},     {"copper", {0xb8684a}},
    {"gold", {0xf8d84a}},  {"redstone", {0xc01a0a}}, {"emerald", {0x2acb57}},
    {"lapis", {0x2350b0}}, {"diamond", {0x5decf0}},  {"quartz", {0xe6dcd2}},
};

/// The colours of copper as it ages.
constexpr NamedAppearance kCoppers[] = {
    {"exposed_", {0xa17e68}},
    {"weathered_", {0x6d916b}},
    {"oxidized_", {0x52a385}},
    {"", {0xc06c50}},
};

/// Coral by kind.
constexpr NamedAppearance kCorals[] = {
    {"dead_", {0x847c78}},   {"tube_", {0x3157ce}}, {"brain_", {0xcf5b9f}},
    {"bubble_", {0xa51a9f}}, {"fire_", {0xa4232f}}, {"horn_", {0xd8c742}},
};

/// Ends of names that are a shape of the material before them.
struct NameEnd {
  std::string_view end;
  Form form;
};
constexpr NameEnd kShapes[] = {
    {"_stairs", Form::solid},
    {"_slab", Form::solid},
    {"_wall_hanging_sign", Form::thin},
    {"_hanging_sign", Form::thin},
    {"_wall_sign", Form::thin},
    {"_sign", Form::thin},
    {"_wall", Form::solid},
    {"_fence_gate", Form::solid},
    {"_fence", Form::solid},
    {"_trapdoor", Form::solid},
    {"_door", Form::solid},
    {"_button", Form::thin},
    {"_pressure_plate", Form::thin},
    {"_shelf", Form::solid},
    {"_pane", Form::clear},
    {"_mosaic", Form::solid},
    {"_carpet", Form::thin},
    {"_plant", Form::thin},
};

/// Words of a name that change a colour a little, by the share of the second colour in percent.
struct Finish {
  std::string_view begin;
  std::uint32_t towards;
  int percent;
};
constexpr Finish kFinishes[] = {
    {"mossy_", 0x5a7a35, 30},    {"polished_", 0xffffff, 5}, {"chiseled_", 0x000000, 4},
    {"cracked_", 0x000000, 7},   {"smooth_", 0xffffff, 4},   {"cut_", 0xffffff, 2},
    {"infested_", 0x7e7e7e, 10}, {"waxed_", 0, 0},           {"petrified_", 0, 0},
    {"chipped_", 0, 0},          {"damaged_", 0, 0},         {"trapped_", 0, 0},
};

/// Colours by words, for blocks of modifications and of later versions. The first word found
/// decides, so specific words precede general ones.
constexpr NamedAppearance kBlockWords[] = {
    {"torch", {0xffd27a, Form::thin}},
    {"lantern", {0xffe2a0}},
    {"lamp", {0xffe9ad}},
    {"sapling", {0x5d8f3a, Form::thin}},
    {"propagule", {0x5d9a4a, Form::thin}},
    {"potted_", {0x7c4535, Form::thin}},
    {"vines", {0x4b7f34, Form::thin}},
    {"vine", {0x4b7f34, Form::thin}},
    {"flower", {0xd07fa0, Form::thin}},
    {"mushroom", {0xb58563, Form::thin}},
    {"fungus", {0xa06050, Form::thin}},
    {"roots", {0x8a6a50, Form::thin}},
    {"sprout", {0x6aa04a, Form::thin}},
    {"grass_block", {0x6f9f46}},
    {"grass", {0x74a64a, Form::thin}},
    {"fern", {0x5f9440, Form::thin}},
    {"crop", {0x86a94a, Form::thin}},
    {"rail", {0x7d6f58, Form::thin}},
    {"wire", {0xb0392f, Form::thin}},
    {"cable", {0x505560, Form::thin}},
    {"ladder", {0x7d6138, Form::thin}},
    {"lever", {0x6f6046, Form::thin}},
    {"button", {0x8a8a8a, Form::thin}},
    {"banner", {0xc0c0c0, Form::thin}},
    {"carpet", {0xc0c0c0, Form::thin}},
    {"candle", {0xe8cfa2, Form::thin}},
    {"skull", {0xbdbdbd, Form::thin}},
    {"_head", {0xbdbdbd, Form::thin}},
    {"chain", {0x333a4a, Form::thin}},
    {"amethyst_bud", {0xa37ecf, Form::thin}},
    {"rod", {0xb0b0b0, Form::thin}},
    {"_fire", {0xf49a33, Form::thin}},
    {"coral", {0xd9776b, Form::wet}},
    {"kelp", {0x578c2d, Form::wet}},
    {"cauldron", {0x4a494a}},
    {"copper", {0xc06c50}},
    {"command_block", {0xb5886c}},
    {"chest", {0x8f6428}},
    {"anvil", {0x444444}},
    {"water", {kWater}},
    {"lava", {0xe8651c}},
    {"glass", {0xd3e8f0, Form::clear, 80}},
    {"ice", {0x91b7fd, Form::clear, 210}},
    {"snow", {0xf6fbfb}},
    {"leaves", {0x4f8a2f}},
    {"bush", {0x4a8234, Form::thin}},
    {"sandstone", {0xd8cb9b}},
    {"obsidian", {0x161020}},
    {"deepslate", {0x505053}},
    {"blackstone", {0x2b2429}},
    {"basalt", {0x50515a}},
    {"marble", {0xdcdad6}},
    {"limestone", {0xb5ab95}},
    {"slate", {0x55585c}},
    {"brick", {0x97604f}},
    {"tile", {0x8a8078}},
    {"cobble", {0x7a7a7a}},
    {"stone", {0x7e7e7e}},
    {"gravel", {0x837f7e}},
    {"clay", {0xa0a6b3}},
    {"terracotta", {0x985e43}},
    {"moss", {0x596d2d}},
    {"mud", {0x4a4542}},
    {"dirt", {0x866043}},
    {"soil", {0x76553b}},
    {"sand", {0xdbcfa3}},
    {"diamond", {0x62ede4}},
    {"emerald", {0x2acb57}},
    {"gold", {0xf6d03d}},
    {"steel", {0xa5a8ab}},
    {"iron", {0xdcdcdc}},
    {"silver", {0xc8ccd2}},
    {"bronze", {0xa9793f}},
    {"brass", {0xc9a24a}},
    {"tin_", {0xbcc2c8}},
    {"zinc", {0xb0b8b0}},
    {"lead", {0x5a6070}},
    {"quartz", {0xebe5de}},
    {"amethyst", {0x8561bf}},
    {"crystal", {0xa8b8e0}},
    {"wool", {0xe4e7e8}},
    {"bed", {0xa12722}},
    {"plank", {0xa2834f}},
    {"wood", {0xa2834f}},
    {"log", {0x6d5533}},
    {"stem", {0x6d5533}},
    {"fence", {0xa2834f}},
    {"door", {0xa2834f}},
    {"ore", {0x8a8480}},
    {"sculk", {0x0d1e24}},
};

// The alpha of thin blocks that are kept, which become see-through cubes.
constexpr std::uint8_t kKeptAlpha = 176;
// A longer name gets a colour by its hash: the game has none.
constexpr std::size_t kComposedNameBytesMax = 128;

std::uint64_t hash_of_name(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return mix64(hash);
}

/// Returns the colour that lies `percent` of the way from one to another.
constexpr std::uint32_t mixed(std::uint32_t from, std::uint32_t to, int percent) {
  std::uint32_t out = 0;
  for (int shift = 16; shift >= 0; shift -= 8) {
    const int a = static_cast<int>(from >> shift & 255), b = static_cast<int>(to >> shift & 255);
    out |= static_cast<std::uint32_t>(a + (b - a) * percent / 100) << shift;
  }
  return out;
}

template <class List>
const auto* find_named(const List& list, std::string_view name) {
  const auto* found = std::find_if(std::begin(list), std::end(list),
                                   [&](const auto& entry) { return entry.name == name; });
  return found == std::end(list) ? nullptr : found;
}

template <class List>
const auto* find_begin(const List& list, std::string_view name) {
  const auto* found = std::find_if(std::begin(list), std::end(list),
                                   [&](const auto& entry) { return name.starts_with(entry.name); });
  return found == std::end(list) ? nullptr : found;
}

std::optional<Appearance> dyed(std::string_view name) {
  const auto* dye = find_begin(kDyes16, name);
  if (dye == nullptr || name.size() <= dye->name.size()) return std::nullopt;
  const auto* kind = find_named(kDyed, name.substr(dye->name.size() + 1));
  if (kind == nullptr || name[dye->name.size()] != '_') return std::nullopt;
  return Appearance{mixed(kind->rest, dye->appearance.rgb, kind->dye_percent), kind->form,
                    kind->alpha};
}

std::optional<Appearance> wooden(std::string_view name) {
  const bool stripped = name.starts_with("stripped_");
  if (stripped) name.remove_prefix(9);
  const auto* wood = find_begin(kWoods, name);
  if (wood == nullptr) return std::nullopt;
  const std::string_view part = name.substr(wood->name.size());
  if (part.empty() || part == "_planks" || part == "_mosaic") return Appearance{wood->planks};
  if (part == "_log" || part == "_wood" || part == "_stem" || part == "_hyphae" || part == "_block")
    return Appearance{stripped ? wood->stripped : wood->bark};
  if (part == "_leaves") return Appearance{wood->leaves};
  if (part == "_sapling" || part == "_propagule") return Appearance{wood->leaves, Form::thin};
  return std::nullopt;
}

std::optional<Appearance> ore(std::string_view name) {
  if (!name.ends_with("_ore")) return std::nullopt;
  name.remove_suffix(4);
  std::uint32_t stone = 0x7e7e7e;
  if (name.starts_with("deepslate_")) {
    stone = 0x505053;
    name.remove_prefix(10);
  } else if (name.starts_with("nether_")) {
    stone = 0x622626;
    name.remove_prefix(7);
  }
  const auto* metal = find_named(kOres, name);
  if (metal == nullptr) return std::nullopt;
  return Appearance{mixed(stone, metal->appearance.rgb, 38)};
}

std::optional<Appearance> copper(std::string_view name) {
  const auto* age = find_begin(kCoppers, name);
  name.remove_prefix(age->name.size());
  Appearance out = age->appearance;
  if (name == "copper_bulb") out.rgb = mixed(out.rgb, 0x402010, 35);
  if (name == "lightning_rod" || name == "copper_chain" || name == "copper_lantern")
    out.form = Form::thin;
  if (name == "copper_bars" || name == "copper_grate") {
    out.form = Form::clear;
    out.alpha = 190;
  }
  if (name.starts_with("copper") || name.starts_with("cut_copper") ||
      name.starts_with("chiseled_copper") || name == "lightning_rod")
    return out;
  return std::nullopt;
}

std::optional<Appearance> coral(std::string_view name) {
  const std::size_t at = name.find("coral");
  const auto* kind = find_begin(kCorals, name);
  if (at == std::string_view::npos || kind == nullptr) return std::nullopt;
  return Appearance{kind->appearance.rgb, name.ends_with("_block") ? Form::solid : Form::wet};
}

/// Returns how a name looks that the tables name or compose, or nullopt.
std::optional<Appearance> known_appearance(std::string_view name) {
  if (const auto* found = find_named(kBlocks, name)) return found->appearance;
  for (const auto rule : {dyed, wooden, ore, coral, copper}) {
    if (const auto found = rule(name)) return found;
  }
  return std::nullopt;
}

/// Returns how a name looks, which may be a shape or a finish of a known one. Each step of the loop
/// shortens the name.
std::optional<Appearance> composed_appearance(std::string_view name) {
  std::optional<Form> form;
  std::uint32_t towards = 0;
  int percent = 0;
  while (true) {
    // "bamboo_fence" has the colour of planks, although "bamboo" is a plant.
    auto found = form ? wooden(name) : std::nullopt;
    if (!found) found = known_appearance(name);
    for (const std::string_view more : {"s", "_block", "_planks", "_ore"}) {
      if (!found && form) found = known_appearance(std::string(name).append(more));
    }
    if (found) {
      found->rgb = mixed(found->rgb, towards, percent);
      if (form && found->form == Form::solid) found->form = *form;
      return found;
    }
    const auto* shape = std::find_if(std::begin(kShapes), std::end(kShapes),
                                     [&](const NameEnd& s) { return name.ends_with(s.end); });
    if (shape != std::end(kShapes)) {
      name.remove_suffix(shape->end.size());
      if (!form) form = shape->form;
      continue;
    }
    const auto* finish = std::find_if(std::begin(kFinishes), std::end(kFinishes),
                                      [&](const Finish& f) { return name.starts_with(f.begin); });
    if (finish == std::end(kFinishes)) return std::nullopt;
    name.remove_prefix(finish->begin.size());
    if (percent == 0) {
      towards = finish->towards;
      percent = finish->percent;
    }
    // "chiseled_quartz_block" is found as it is, but "smooth_quartz" as "quartz_block".
    if (!form) form = Form::solid;
  }
}

Appearance appearance_of(std::string_view name) {
  const std::uint64_t hash = hash_of_name(name);
  if (name.size() <= kComposedNameBytesMax) {
    if (name.starts_with("potted_")) return {0x7c4535, Form::thin};
    // "redstone_wall_torch" looks like "redstone_torch", and "wall_torch" like "torch".
    std::string standing(name);
    if (const std::size_t wall = standing.find("wall_"); wall != std::string::npos) {
      standing.erase(wall, 5);
      if (const auto found = known_appearance(standing)) return *found;
    }
    if (const auto found = composed_appearance(name)) return *found;
    for (const NamedAppearance& word : kBlockWords) {
      if (name.find(word.name) == std::string_view::npos) continue;
      Appearance out = word.appearance;
      // The shade depends on the name, so that different blocks of one kind can be distinguished.
      out.rgb = mixed(out.rgb, hash & 1 ? 0xffffff : 0, static_cast<int>(hash >> 1 & 7));
      return out;
    }
  }
  // A pale to medium colour.
  std::uint32_t rgb = 0;
  for (int channel = 0; channel < 3; ++channel)
    rgb = rgb << 8 | static_cast<std::uint32_t>(96 + (hash >> (8 * channel)) % 112);
  return {rgb};
}

/// Blocks that give off light, and how much in percent. Those with a state "lit" do so if it is
/// true.
struct Light {
  std::string_view word;
  std::uint8_t percent;
};
constexpr Light kLights[] = {
    {"sea_lantern", 90},   {"jack_o_lantern", 80}, {"lantern", 100},         {"glowstone", 90},
    {"redstone_lamp", 90}, {"redstone_torch", 40}, {"torch", 100},           {"shroomlight", 90},
    {"froglight", 90},     {"lava", 90},           {"magma_block", 40},      {"soul_fire", 80},
    {"campfire", 80},      {"fire", 100},          {"beacon", 90},           {"end_rod", 90},
    {"copper_bulb", 80},   {"nether_portal", 60},  {"end_portal", 40},       {"end_gateway", 60},
    {"candle", 60},        {"glow_lichen", 30},    {"crying_obsidian", 30},  {"conduit", 80},
    {"furnace", 30},       {"smoker", 30},         {"enchanting_table", 20},
};

std::uint8_t emission_of(std::string_view name, const StateList& states) {
  if (name.find("coral") != std::string_view::npos || name.starts_with("torchflower") ||
      name.starts_with("potted_") || name == "end_portal_frame" || name == "firefly_bush")
    return 0;
  const auto* light = std::find_if(std::begin(kLights), std::end(kLights), [&](const Light& l) {
    return name.find(l.word) != std::string_view::npos;
  });
  if (light == std::end(kLights)) return 0;
  const auto lit = std::find_if(states.begin(), states.end(),
                                [](const auto& state) { return state.first == "lit"; });
  return lit != states.end() && lit->second != "true" ? std::uint8_t{0} : light->percent;
}

MaterialLook surface_of(std::string_view name, MaterialBody body, const Shape& shape,
                        const StateList& states) {
  std::string_view like = name;
  if (name.ends_with("_wood") || name.ends_with("_hyphae")) like = "log";
  if (name.ends_with("_ore") || name.ends_with("_coral_block")) like = "stone";
  const auto* wood = find_begin(kWoods, name);
  if (wood != nullptr && std::any_of(std::begin(kShapes), std::end(kShapes),
                                     [&](const NameEnd& s) { return name.ends_with(s.end); }))
    like = "planks";
  MaterialLook look = default_look(like, body, shape);
  // The words of default_look() do not know which blocks of this game are lit.
  look.emission = emission_of(name, states);
  return look;
}

bool has_state(const StateList& states, std::string_view key, std::string_view value) {
  return std::any_of(states.begin(), states.end(), [&](const auto& state) {
    return state.first == key && state.second == value;
  });
}

}  // namespace

MaterialInfo material_of_minecraft_block(const ForeignBlock& given, bool keep_all) {
  const ForeignBlock block = with_default_states(given);
  const std::string_view whole = block.name;
  const std::string_view name = whole.substr(whole.find(':') + 1);
  const StateList states = split_states(block.states).value_or(StateList{});
  Appearance appearance = appearance_of(name);
  if (name == "grass_block" && has_state(states, "snowy", "true")) appearance.rgb = 0xf0f5f6;
  if (name == "redstone_lamp" && has_state(states, "lit", "true")) appearance.rgb = 0xd9a86a;

  MaterialInfo out;
  out.name = minecraft_material_name(block);
  if (appearance.form == Form::air) {
    out.visibility = Visibility::empty;
    out.colour = {0, 0, 0, 0};
    return out;
  }
  const bool is_thin = appearance.form == Form::thin || appearance.form == Form::wet;
  const std::optional<Shape> shape = shape_of_material_name(out.name);
  if (is_thin && !keep_all) {
    // A voxel has no room for seagrass and its water: the plant would be a hole in the sea.
    const bool in_water = states.empty() || !has_state(states, "waterlogged", "false");
    if ((appearance.form == Form::wet && in_water) || has_state(states, "waterlogged", "true"))
      return material_of_minecraft_block({"minecraft:water", ""}, keep_all);
  }
  const std::uint32_t rgb = appearance.rgb;
  out.colour = {static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8),
                static_cast<std::uint8_t>(rgb), 255};
  if (is_thin && shape) {
    out.body = MaterialBody::passable;
  } else if (is_thin) {
    out.visibility = keep_all ? Visibility::transparent : Visibility::empty;
    if (keep_all) out.body = MaterialBody::passable;
    out.colour[3] = kKeptAlpha;
  } else if (appearance.form == Form::clear || appearance.alpha < 255) {
    out.visibility = Visibility::transparent;
    out.colour[3] = appearance.alpha;
  }
  if (appearance.form == Form::liquid) out.body = MaterialBody::liquid;
  if (name == "nether_portal" || name == "end_portal" || name == "end_gateway")
    out.body = MaterialBody::passable;
  if (shape && out.visibility != Visibility::empty) out.shape = *shape;
  // It is stored, so that every client draws the world alike.
  out.look = surface_of(name, out.body, out.shape, states);
  return out;
}

}  // namespace runstone
