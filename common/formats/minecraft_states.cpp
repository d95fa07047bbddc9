// The rules of this file are facts about the blocks of Minecraft Java 1.13 to 1.21.
#include "common/formats/minecraft_states.hpp"

#include <algorithm>
#include <array>

namespace runstone {
namespace {

// The order of the values is frozen: minecraft_material_name() writes their indices. Values may be
// appended. The default is the first one.
constexpr MinecraftProperty kFacing = "facing=north|south|west|east";
constexpr MinecraftProperty kFacingAll = "facing=north|east|south|west|up|down";
constexpr MinecraftProperty kFacingUp = "facing=up|north|east|south|west|down";
constexpr MinecraftProperty kFacingSouth = "facing=south|north|east|west|up|down";
constexpr MinecraftProperty kFacingDown = "facing=down|north|south|west|east";
constexpr MinecraftProperty kAxis = "axis=y|x|z";
constexpr MinecraftProperty kHalfBottom = "half=bottom|top";
constexpr MinecraftProperty kHalfLower = "half=lower|upper";
constexpr MinecraftProperty kWaterlogged = "waterlogged=false|true";
constexpr MinecraftProperty kInWater = "waterlogged=true|false";
constexpr MinecraftProperty kOpen = "open=false|true";
constexpr MinecraftProperty kPowered = "powered=false|true";
constexpr MinecraftProperty kTriggered = "triggered=false|true";
constexpr MinecraftProperty kLit = "lit=false|true";
constexpr MinecraftProperty kLitTrue = "lit=true|false";
constexpr MinecraftProperty kAttached = "attached=false|true";
constexpr MinecraftProperty kHanging = "hanging=false|true";
constexpr MinecraftProperty kNorth = "north=false|true", kSouth = "south=false|true",
                            kWest = "west=false|true", kEast = "east=false|true",
                            kUp = "up=false|true", kDown = "down=false|true";
// The last two values are those before 1.16.
constexpr MinecraftProperty kNorthWall = "north=none|low|tall|false|true",
                            kSouthWall = "south=none|low|tall|false|true",
                            kWestWall = "west=none|low|tall|false|true",
                            kEastWall = "east=none|low|tall|false|true";
constexpr MinecraftProperty kNorthWire = "north=none|side|up", kSouthWire = "south=none|side|up",
                            kWestWire = "west=none|side|up", kEastWire = "east=none|side|up";
constexpr MinecraftProperty kNorthSkin = "north=true|false", kSouthSkin = "south=true|false",
                            kWestSkin = "west=true|false", kEastSkin = "east=true|false",
                            kUpSkin = "up=true|false", kDownSkin = "down=true|false";
constexpr MinecraftProperty kRotation = "rotation=0|1|2|3|4|5|6|7|8|9|10|11|12|13|14|15";
constexpr MinecraftProperty kPower = "power=0|1|2|3|4|5|6|7|8|9|10|11|12|13|14|15";
constexpr MinecraftProperty kAge2 = "age=0|1|2", kAge3 = "age=0|1|2|3", kAge4 = "age=0|1|2|3|4",
                            kAge5 = "age=0|1|2|3|4|5", kAge7 = "age=0|1|2|3|4|5|6|7",
                            kAge15 = "age=0|1|2|3|4|5|6|7|8|9|10|11|12|13|14|15",
                            kAge25 =
                                "age=0|1|2|3|4|5|6|7|8|9|10|11|12|13|14|15|16|17|18|19|20|"
                                "21|22|23|24|25";
constexpr MinecraftProperty kDistance = "distance=7|1|2|3|4|5|6|0";
constexpr MinecraftProperty kStage = "stage=0|1";
constexpr MinecraftProperty kFace = "face=wall|floor|ceiling";
constexpr MinecraftProperty kRailShape =
    "shape=north_south|east_west|ascending_east|ascending_west|ascending_north|ascending_south|"
    "south_east|south_west|north_west|north_east";
constexpr MinecraftProperty kOrientation =
    "orientation=north_up|down_east|down_north|down_south|down_west|up_east|up_north|up_south|"
    "up_west|west_up|east_up|south_up";
constexpr MinecraftProperty kSensorPhase = "sculk_sensor_phase=inactive|active|cooldown";

struct StateRule {
  std::string_view names;  // as rule_names() reads them
  // Ascending by key. Empty: no property.
  std::array<MinecraftProperty, 7> properties;
};

/// The first rule that names a block holds, so exceptions precede the ends of names.
constexpr StateRule kRules[] = {
    {"potted_* sea_lantern bamboo_sapling", {}},
    {"*_stairs",
     {kFacing, kHalfBottom, "shape=straight|inner_left|inner_right|outer_left|outer_right",
      kWaterlogged}},
    {"*_slab", {"type=bottom|top|double", kWaterlogged}},
    {"*_leaves", {kDistance, "persistent=false|true", kWaterlogged}},
    {"*_trapdoor", {kFacing, kHalfBottom, kOpen, kPowered, kWaterlogged}},
    {"*_door", {kFacing, kHalfLower, "hinge=left|right", kOpen, kPowered}},
    {"*_fence_gate", {kFacing, "in_wall=false|true", kOpen, kPowered}},
    {"*_fence *_pane *_bars", {kEast, kNorth, kSouth, kWaterlogged, kWest}},
    {"*_wall", {kEastWall, kNorthWall, kSouthWall, "up=true|false", kWaterlogged, kWestWall}},
    {"*_bed", {kFacing, "occupied=false|true", "part=foot|head"}},
    {"*_wall_banner", {kFacing}},
    {"*_banner", {kRotation}},
    {"*_wall_hanging_sign *_wall_sign wall_sign ladder ender_chest big_dripleaf_stem",
     {kFacing, kWaterlogged}},
    {"*_hanging_sign", {kAttached, kRotation, kWaterlogged}},
    {"*_sign sign", {kRotation, kWaterlogged}},
    {"light_weighted_pressure_plate heavy_weighted_pressure_plate target", {kPower}},
    {"*_pressure_plate", {kPowered}},
    {"*_button lever", {kFace, kFacing, kPowered}},
    {"grindstone", {kFace, kFacing}},
    {"*_shulker_box shulker_box end_rod", {kFacingUp}},
    {"*_candle candle", {"candles=1|2|3|4", kLit, kWaterlogged}},
    {"*candle_cake", {kLit}},
    {"*_wall_skull *_wall_head", {kFacing, kPowered}},
    {"piston_head", {kFacingAll, "short=false|true", "type=normal|sticky"}},
    {"*_skull *_head", {kPowered, kRotation}},
    {"*_coral_wall_fan", {kFacing, kInWater}},
    {"*_coral *_coral_fan conduit", {kInWater}},
    {"*_bulb", {kLit, kPowered}},
    {"*_grate barrier hanging_roots heavy_core mangrove_roots", {kWaterlogged}},
    {"*_amethyst_bud amethyst_cluster", {kFacingUp, kWaterlogged}},
    {"lightning_rod *_lightning_rod", {kFacingUp, kPowered, kWaterlogged}},
    {"redstone_wall_torch", {kFacing, kLitTrue}},
    {"redstone_torch", {kLitTrue}},
    {"*wall_torch", {kFacing}},
    {"mangrove_propagule", {kAge4, kHanging, kStage, kWaterlogged}},
    {"*_sapling", {kStage}},
    {"redstone_ore deepslate_redstone_ore redstone_lamp", {kLit}},
    {"pumpkin_stem melon_stem wheat carrots potatoes", {kAge7}},
    {"mushroom_stem brown_mushroom_block red_mushroom_block",
     {kDownSkin, kEastSkin, kNorthSkin, kSouthSkin, kUpSkin, kWestSkin}},
    {"attached_pumpkin_stem attached_melon_stem carved_pumpkin jack_o_lantern anvil chipped_anvil "
     "damaged_anvil loom stonecutter *_glazed_terracotta",
     {kFacing}},
    {"*_log *_stem *_hyphae *_wood basalt polished_basalt quartz_pillar purpur_pillar hay_block "
     "bone_block deepslate infested_deepslate *_froglight muddy_mangrove_roots bamboo_block "
     "stripped_bamboo_block",
     {kAxis}},
    {"chain *_chain", {kAxis, kWaterlogged}},
    {"nether_portal", {"axis=x|z"}},
    {"grass_block podzol mycelium", {"snowy=false|true"}},
    {"water lava", {"level=0|1|2|3|4|5|6|7|8|9|10|11|12|13|14|15"}},
    {"water_cauldron powder_snow_cauldron", {"level=1|2|3"}},
    {"composter", {"level=0|1|2|3|4|5|6|7|8"}},
    {"light", {"level=15|0|1|2|3|4|5|6|7|8|9|10|11|12|13|14", kWaterlogged}},
    {"furnace smoker blast_furnace", {kFacing, kLit}},
    {"campfire soul_campfire", {kFacing, kLitTrue, "signal_fire=false|true", kWaterlogged}},
    {"chest trapped_chest *_chest", {kFacing, "type=single|left|right", kWaterlogged}},
    {"barrel", {kFacingAll, kOpen}},
    {"hopper", {"enabled=true|false", kFacingDown}},
    {"dispenser dropper", {kFacingAll, kTriggered}},
    {"piston sticky_piston", {"extended=false|true", kFacingAll}},
    {"moving_piston", {kFacingAll, "type=normal|sticky"}},
    {"observer", {kFacingSouth, kPowered}},
    {"command_block *_command_block", {"conditional=false|true", kFacingAll}},
    {"rail", {kRailShape, kWaterlogged}},
    {"*_rail", {kPowered, kRailShape, kWaterlogged}},
    {"redstone_wire", {kEastWire, kNorthWire, kPower, kSouthWire, kWestWire}},
    {"repeater", {"delay=1|2|3|4", kFacing, "locked=false|true", kPowered}},
    {"comparator", {kFacing, "mode=compare|subtract", kPowered}},
    {"daylight_detector", {"inverted=false|true", kPower}},
    {"note_block",
     {"instrument=harp|basedrum|snare|hat|bass|flute|bell|guitar|chime|xylophone|iron_xylophone|"
      "cow_bell|didgeridoo|bit|banjo|pling|zombie|skeleton|creeper|dragon|wither_skeleton|piglin|"
      "custom_head",
      "note=0|1|2|3|4|5|6|7|8|9|10|11|12|13|14|15|16|17|18|19|20|21|22|23|24", kPowered}},
    {"tripwire_hook", {kAttached, kFacing, kPowered}},
    {"tripwire", {kAttached, "disarmed=false|true", kEast, kNorth, kPowered, kSouth, kWest}},
    {"tnt", {"unstable=false|true"}},
    {"jukebox", {"has_record=false|true"}},
    {"lectern", {kFacing, "has_book=false|true", kPowered}},
    {"bell", {"attachment=floor|ceiling|single_wall|double_wall", kFacing, kPowered}},
    {"lantern *_lantern", {kHanging, kWaterlogged}},
    {"bee_nest beehive", {kFacing, "honey_level=0|1|2|3|4|5"}},
    {"brewing_stand",
     {"has_bottle_0=false|true", "has_bottle_1=false|true", "has_bottle_2=false|true"}},
    {"chiseled_bookshelf",
     {kFacing, "slot_0_occupied=false|true", "slot_1_occupied=false|true",
      "slot_2_occupied=false|true", "slot_3_occupied=false|true", "slot_4_occupied=false|true",
      "slot_5_occupied=false|true"}},
    {"*_shelf", {kFacing, kPowered, "side_chain=unconnected|right|center|left", kWaterlogged}},
    {"*_golem_statue", {"copper_golem_pose=standing|sitting|running|star", kFacing, kWaterlogged}},
    {"end_portal_frame", {"eye=false|true", kFacing}},
    {"respawn_anchor", {"charges=0|1|2|3|4"}},
    {"structure_block", {"mode=load|save|corner|data"}},
    {"test_block", {"mode=start|log|fail|accept"}},
    {"jigsaw", {kOrientation}},
    {"crafter", {"crafting=false|true", kOrientation, kTriggered}},
    {"decorated_pot", {"cracked=false|true", kFacing, kWaterlogged}},
    {"trial_spawner",
     {"ominous=false|true",
      "trial_spawner_state=inactive|waiting_for_players|active|waiting_for_reward_ejection|"
      "ejecting_reward|cooldown"}},
    {"vault", {kFacing, "ominous=false|true", "vault_state=inactive|active|unlocking|ejecting"}},
    {"sculk_sensor", {kPower, kSensorPhase, kWaterlogged}},
    {"calibrated_sculk_sensor", {kFacing, kPower, kSensorPhase, kWaterlogged}},
    {"sculk_catalyst", {"bloom=false|true"}},
    {"sculk_shrieker", {"can_summon=false|true", "shrieking=false|true", kWaterlogged}},
    {"glow_lichen resin_clump sculk_vein",
     {kDown, kEast, kNorth, kSouth, kUp, kWaterlogged, kWest}},
    {"creaking_heart",
     {kAxis, "creaking_heart_state=uprooted|dormant|awake", "natural=false|true"}},
    {"dried_ghast", {kFacing, "hydration=0|1|2|3", kWaterlogged}},
    {"snow", {"layers=1|2|3|4|5|6|7|8"}},
    {"cake", {"bites=0|1|2|3|4|5|6"}},
    {"farmland", {"moisture=0|1|2|3|4|5|6|7"}},
    {"suspicious_sand suspicious_gravel", {"dusted=0|1|2|3"}},
    {"frosted_ice nether_wart beetroots sweet_berry_bush", {kAge3}},
    {"cactus sugar_cane", {kAge15}},
    {"kelp weeping_vines twisting_vines", {kAge25}},
    {"cave_vines", {kAge25, "berries=false|true"}},
    {"cave_vines_plant", {"berries=false|true"}},
    {"fire", {kAge15, kEast, kNorth, kSouth, kUp, kWest}},
    {"vine", {kEast, kNorth, kSouth, kUp, kWest}},
    {"chorus_plant", {kDown, kEast, kNorth, kSouth, kUp, kWest}},
    {"chorus_flower", {kAge5}},
    {"cocoa", {kAge2, kFacing}},
    {"torchflower_crop", {kAge2}},
    {"pitcher_crop", {kAge4, kHalfLower}},
    {"tall_seagrass sunflower lilac rose_bush peony tall_grass large_fern pitcher_plant",
     {kHalfLower}},
    {"small_dripleaf", {kFacing, kHalfLower, kWaterlogged}},
    {"big_dripleaf", {kFacing, "tilt=none|unstable|partial|full", kWaterlogged}},
    {"pink_petals wildflowers", {kFacing, "flower_amount=1|2|3|4"}},
    {"leaf_litter", {kFacing, "segment_amount=1|2|3|4"}},
    {"bamboo", {"age=0|1", "leaves=none|small|large", kStage}},
    {"turtle_egg", {"eggs=1|2|3|4", "hatch=0|1|2"}},
    {"sniffer_egg", {"hatch=0|1|2"}},
    {"sea_pickle", {"pickles=1|2|3|4", kInWater}},
    {"bubble_column", {"drag=true|false"}},
    {"scaffolding", {"bottom=false|true", kDistance, kWaterlogged}},
    {"pointed_dripstone",
     {"thickness=tip|tip_merge|frustum|middle|base", "vertical_direction=up|down", kWaterlogged}},
    {"pale_moss_carpet", {"bottom=true|false", kEastWall, kNorthWall, kSouthWall, kWestWall}},
    {"pale_hanging_moss", {"tip=true|false"}},
};

bool is_state_text(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

/// Returns true if `text` fits a pattern in which '*' stands for any text.
bool fits_pattern(std::string_view pattern, std::string_view text) {
  std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == text;
  if (!text.starts_with(pattern.substr(0, star))) return false;
  text.remove_prefix(star);
  pattern.remove_prefix(star + 1);
  // The first place of each part between two stars leaves most for the parts that follow.
  while ((star = pattern.find('*')) != std::string_view::npos) {
    const std::size_t at = text.find(pattern.substr(0, star));
    if (at == std::string_view::npos) return false;
    text.remove_prefix(at + star);
    pattern.remove_prefix(star + 1);
  }
  return text.ends_with(pattern);
}

std::string_view values_of(MinecraftProperty property) {
  return property.substr(property.find('=') + 1);
}

}  // namespace

bool rule_names(std::string_view names, std::string_view name) {
  while (!names.empty()) {
    const std::size_t end = std::min(names.find(' '), names.size());
    if (fits_pattern(names.substr(0, end), name)) return true;
    names.remove_prefix(std::min(end + 1, names.size()));
  }
  return false;
}

std::vector<MinecraftProperty> minecraft_properties(std::string_view name) {
  for (const StateRule& rule : kRules) {
    if (!rule_names(rule.names, name)) continue;
    std::vector<MinecraftProperty> out;
    for (const MinecraftProperty property : rule.properties) {
      if (!property.empty()) out.push_back(property);
    }
    return out;
  }
  return {};
}

std::string_view key_of(MinecraftProperty property) {
  return property.substr(0, property.find('='));
}

std::size_t value_count(MinecraftProperty property) {
  return 1 + static_cast<std::size_t>(std::count(property.begin(), property.end(), '|'));
}

std::string_view value_of(MinecraftProperty property, std::size_t index) {
  std::string_view values = values_of(property);
  for (; index > 0; --index) values.remove_prefix(values.find('|') + 1);
  return values.substr(0, values.find('|'));
}

std::optional<std::size_t> index_of_value(MinecraftProperty property, std::string_view value) {
  const std::size_t count = value_count(property);
  for (std::size_t i = 0; i < count; ++i) {
    if (value_of(property, i) == value) return i;
  }
  return std::nullopt;
}

std::optional<StateList> split_states(std::string_view states) {
  StateList out;
  while (!states.empty()) {
    const std::size_t end = std::min(states.find(','), states.size());
    const std::string_view one = states.substr(0, end);
    const std::size_t equals = one.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    const std::string_view key = one.substr(0, equals), value = one.substr(equals + 1);
    if (!is_state_text(key) || !is_state_text(value)) return std::nullopt;
    if (!out.empty() && out.back().first >= key) return std::nullopt;
    out.emplace_back(key, value);
    if (end + 1 == states.size()) return std::nullopt;  // ends with a comma
    states.remove_prefix(std::min(end + 1, states.size()));
  }
  return out;
}

std::string join_states(const StateList& states) {
  std::string out;
  for (const auto& [key, value] : states) {
    if (!out.empty()) out += ',';
    out.append(key).append("=").append(value);
  }
  return out;
}

}  // namespace runstone
