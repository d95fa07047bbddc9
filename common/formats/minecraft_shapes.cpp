#include "common/formats/minecraft_shapes.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>
#include <utility>

#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_states.hpp"
#include "common/shapes/shape_kinds.hpp"
#include "common/shapes/shape_states.hpp"
#include "common/shapes/turned_shape.hpp"

namespace runstone {
namespace {

constexpr std::array<std::string_view, 4> kBlockSides = {"north", "east", "south", "west"};

/// Returns a box of this height that keeps `inset` sixteenths from the voxel's sides.
Shape low_box(unsigned height, unsigned inset = 0) {
  return shape_of_boxes({shape_box(inset, 0, inset, 16 - inset, height, 16 - inset)});
}

/// Shapes of one size, by their names. They are written for facing=north.
struct FixedShape {
  std::string_view names;
  std::array<ShapeBox, 8> boxes;
  std::size_t count;
};
template <class... Boxes>
constexpr FixedShape fixed(std::string_view names, Boxes... boxes) {
  return {names, {boxes...}, sizeof...(boxes)};
}
constexpr FixedShape kFixed[] = {
    fixed("enchanting_table", shape_box(0, 0, 0, 16, 12, 16)),
    fixed("daylight_detector", shape_box(0, 0, 0, 16, 6, 16)),
    fixed("sculk_sensor sculk_shrieker", shape_box(0, 0, 0, 16, 8, 16)),
    fixed("calibrated_sculk_sensor", shape_box(0, 0, 0, 16, 8, 16), shape_box(7, 8, 4, 9, 16, 12)),
    fixed("end_portal", shape_box(0, 6, 0, 16, 12, 16)),
    fixed("conduit", shape_box(5, 5, 5, 11, 11, 11)),
    fixed("heavy_core", shape_box(4, 0, 4, 12, 8, 12)),
    fixed("sniffer_egg decorated_pot", shape_box(1, 0, 1, 15, 16, 15)),
    fixed("dried_ghast", shape_box(3, 0, 3, 13, 10, 13)),
    fixed("*_golem_statue", shape_box(3, 0, 3, 13, 14, 13)),
    fixed("flower_pot", shape_box(5, 0, 5, 11, 6, 11)),
    fixed("potted_*", shape_box(5, 0, 5, 11, 6, 11), shape_box(7, 6, 7, 9, 14, 9)),
    fixed("lily_pad frogspawn", shape_box(1, 0, 1, 15, 1, 15)),
    fixed("leaf_litter pink_petals wildflowers", shape_box(0, 0, 0, 16, 1, 16)),
    fixed("spore_blossom", shape_box(1, 13, 1, 15, 16, 15)),
    fixed("azalea flowering_azalea", shape_box(0, 8, 0, 16, 16, 16), shape_box(6, 0, 6, 10, 8, 10)),
    fixed("bamboo big_dripleaf_stem", shape_box(6, 0, 6, 10, 16, 10)),
    fixed("big_dripleaf", shape_box(0, 11, 0, 16, 15, 16), shape_box(6, 0, 6, 10, 11, 10)),
    fixed("*_coral_wall_fan", shape_box(0, 7, 5, 16, 9, 16)),
    fixed("*candle_cake", shape_box(1, 0, 1, 15, 8, 15), shape_box(7, 8, 7, 9, 14, 9)),
    fixed("cauldron *_cauldron", shape_box(0, 3, 0, 2, 16, 16), shape_box(14, 3, 0, 16, 16, 16),
          shape_box(2, 3, 0, 14, 16, 2), shape_box(2, 3, 14, 14, 16, 16),
          shape_box(2, 3, 2, 14, 4, 14), shape_box(0, 0, 6, 16, 3, 10),
          shape_box(6, 0, 0, 10, 3, 16)),
    fixed("composter", shape_box(0, 0, 0, 2, 16, 16), shape_box(14, 0, 0, 16, 16, 16),
          shape_box(2, 0, 0, 14, 16, 2), shape_box(2, 0, 14, 14, 16, 16),
          shape_box(2, 0, 2, 14, 2, 14)),
    fixed("brewing_stand", shape_box(1, 0, 1, 15, 2, 15), shape_box(7, 2, 7, 9, 14, 9)),
    fixed("lectern", shape_box(0, 0, 0, 16, 2, 16), shape_box(4, 2, 4, 12, 14, 12),
          shape_box(0, 10, 1, 16, 14, 5), shape_box(0, 12, 5, 16, 16, 10),
          shape_box(0, 14, 10, 16, 16, 14)),
    fixed("stonecutter", shape_box(0, 0, 0, 16, 9, 16), shape_box(1, 9, 7, 15, 16, 9)),
    fixed("campfire soul_campfire", shape_box(1, 0, 0, 5, 4, 16), shape_box(11, 0, 0, 15, 4, 16),
          shape_box(0, 3, 1, 16, 7, 5), shape_box(0, 3, 11, 16, 7, 15),
          shape_box(5, 0, 0, 11, 1, 16)),
    fixed("repeater comparator", shape_box(0, 0, 0, 16, 2, 16), shape_box(7, 2, 2, 9, 7, 4),
          shape_box(7, 2, 8, 9, 7, 10)),
    fixed("tripwire_hook", shape_box(6, 1, 14, 10, 9, 16), shape_box(7, 5, 8, 9, 7, 14)),
    fixed("*_shelf", shape_box(0, 0, 13, 16, 16, 16), shape_box(0, 12, 11, 16, 16, 13),
          shape_box(0, 0, 11, 16, 4, 13)),
    fixed("scaffolding", shape_box(0, 14, 0, 16, 16, 16), shape_box(0, 0, 0, 2, 14, 2),
          shape_box(14, 0, 0, 16, 14, 2), shape_box(0, 0, 14, 2, 14, 16),
          shape_box(14, 0, 14, 16, 14, 16)),
    fixed("dragon_egg", shape_box(3, 0, 3, 13, 1, 13), shape_box(2, 1, 2, 14, 3, 14),
          shape_box(1, 3, 1, 15, 8, 15), shape_box(2, 8, 2, 14, 11, 14),
          shape_box(3, 11, 3, 13, 13, 13), shape_box(5, 13, 5, 11, 15, 11),
          shape_box(6, 15, 6, 10, 16, 10)),
    fixed("chorus_flower", shape_box(2, 0, 2, 14, 16, 14), shape_box(0, 2, 2, 16, 14, 14),
          shape_box(2, 2, 0, 14, 14, 16)),
};

/// Blocks that are two crossed planes, with their height and how far they are from the sides.
struct PlantRule {
  std::string_view names;
  std::uint8_t height;
  std::uint8_t inset = 1;
};
constexpr PlantRule kPlants[] = {
    {"tall_grass large_fern tall_dry_grass sunflower lilac rose_bush peony pitcher_plant seagrass "
     "tall_seagrass kelp kelp_plant sugar_cane cave_vines cave_vines_plant *_vines *_vines_plant "
     "pale_hanging_moss hanging_roots small_dripleaf mangrove_propagule",
     16},
    {"cobweb fire soul_fire", 16, 0},
    {"*_sapling *_coral", 14},
    {"grass short_grass fern short_dry_grass bush firefly_bush dead_bush crimson_roots "
     "warped_roots",
     13},
    {"bamboo_sapling", 12, 4},
    {"torchflower cactus_flower *_eyeblossom", 12, 3},
    {"dandelion poppy blue_orchid allium azure_bluet *_tulip oxeye_daisy cornflower "
     "lily_of_the_valley wither_rose attached_melon_stem attached_pumpkin_stem",
     10, 3},
    {"*_fungus", 9, 3},
    {"brown_mushroom red_mushroom", 6, 5},
    {"*_coral_fan", 5},
    {"nether_sprouts", 4},
};

Shape piston_block(const ShapeStates& states) {
  if (!states.is_true("extended")) return {};
  return upended(low_box(12), states.get("facing", "north"));
}

Shape piston_head_block(const ShapeStates& states) {
  return upended(shape_of_boxes({shape_box(0, 12, 0, 16, 16, 16), shape_box(6, 0, 6, 10, 12, 10)}),
                 states.get("facing", "north"));
}

Shape lightning_rod_block(const ShapeStates& states) {
  return upended(shape_of_boxes({shape_box(6, 12, 6, 10, 16, 10), shape_box(7, 0, 7, 9, 12, 9)}),
                 states.get("facing", "up"));
}

Shape amethyst_block(const ShapeStates& states, unsigned height, unsigned inset) {
  return upended(low_box(height, inset), states.get("facing", "up"));
}
Shape small_amethyst_block(const ShapeStates& states) { return amethyst_block(states, 3, 4); }
Shape medium_amethyst_block(const ShapeStates& states) { return amethyst_block(states, 4, 3); }
Shape large_amethyst_block(const ShapeStates& states) { return amethyst_block(states, 5, 3); }
Shape amethyst_cluster_block(const ShapeStates& states) { return amethyst_block(states, 7, 3); }

Shape hopper_block(const ShapeStates& states) {
  Shape out = shape_of_boxes({shape_box(0, 10, 0, 16, 11, 16), shape_box(0, 11, 0, 2, 16, 16),
                              shape_box(14, 11, 0, 16, 16, 16), shape_box(2, 11, 0, 14, 16, 2),
                              shape_box(2, 11, 14, 14, 16, 16), shape_box(4, 4, 4, 12, 10, 12)});
  const std::string_view facing = states.get("facing", "down");
  out =
      with_boxes(std::move(out),
                 facing == "down" ? shape_of_boxes({shape_box(6, 0, 6, 10, 4, 10)})
                                  : faced(shape_of_boxes({shape_box(6, 4, 0, 10, 8, 4)}), facing));
  return out;
}

Shape cake_block(const ShapeStates& states) {
  const unsigned bites = std::min(states.number("bites", 0), 6U);
  return shape_of_boxes({shape_box(1 + 2 * bites, 0, 1, 15, 8, 15)});
}

Shape end_portal_frame_block(const ShapeStates& states) {
  Shape out = low_box(13);
  if (states.is_true("eye")) out.boxes.push_back(shape_box(4, 13, 4, 12, 16, 12));
  return out;
}

Shape nether_portal_block(const ShapeStates& states) {
  return shape_of_boxes(
      {states.is("axis", "z") ? shape_box(6, 0, 0, 10, 16, 16) : shape_box(0, 0, 6, 16, 16, 10)});
}

Shape wire_block(const ShapeStates& states) {
  Shape out;
  for (const std::string_view side : kBlockSides) {
    const std::string_view value = states.get(side);
    if (value == "side" || value == "up" || value == "true")
      out = with_boxes(std::move(out), faced(shape_of_boxes({shape_box(7, 0, 0, 9, 1, 7)}), side));
    if (value == "up")
      out = with_boxes(std::move(out), faced(shape_of_boxes({shape_box(7, 1, 0, 9, 16, 1)}), side));
  }
  if (out.is_cube()) return low_box(1, 3);
  out.boxes.push_back(shape_box(7, 0, 7, 9, 1, 9));
  return out;
}

Shape chorus_plant_block(const ShapeStates& states) {
  Shape out = shape_of_boxes({shape_box(4, 4, 4, 12, 12, 12)});
  for (const std::string_view side : kBlockSides) {
    if (states.is_true(side))
      out =
          with_boxes(std::move(out), faced(shape_of_boxes({shape_box(4, 4, 0, 12, 12, 4)}), side));
  }
  if (states.is_true("up")) out.boxes.push_back(shape_box(4, 12, 4, 12, 16, 12));
  if (states.is_true("down")) out.boxes.push_back(shape_box(4, 0, 4, 12, 4, 12));
  return out;
}

Shape pale_moss_carpet_block(const ShapeStates& states) {
  Shape out;
  if (states.get("bottom", "true") == "true") out = low_box(1);
  for (const std::string_view side : kBlockSides) {
    const std::string_view value = states.get(side);
    if (value != "low" && value != "true" && value != "tall") continue;
    out = with_boxes(
        std::move(out),
        faced(shape_of_boxes({shape_box(0, 0, 0, 16, value == "tall" ? 16 : 10, 1)}), side));
  }
  return out.is_cube() ? low_box(1) : out;
}

Shape dripstone_block(const ShapeStates& states) {
  const std::string_view part = states.get("thickness", "tip");
  const Shape up = part == "tip"         ? low_box(11, 5)
                   : part == "tip_merge" ? low_box(16, 5)
                   : part == "frustum"   ? low_box(16, 4)
                   : part == "middle"    ? low_box(16, 3)
                                         : low_box(16, 2);
  return states.is("vertical_direction", "down") ? upside_down(up) : up;
}

Shape cocoa_block(const ShapeStates& states) {
  const unsigned age = std::min(states.number("age", 0), 2U);
  return faced(shape_of_boxes({shape_box(6 - age, 7 - 2 * age, 1, 10 + age, 12, 5 + 2 * age)}),
               states.get("facing"));
}

Shape turtle_egg_block(const ShapeStates& states) {
  if (states.number("eggs", 1) <= 1) return low_box(7, 6);
  // No state says how two and three lie, so there are four.
  return shape_of_boxes({shape_box(2, 0, 2, 6, 7, 6), shape_box(10, 0, 2, 14, 7, 6),
                         shape_box(2, 0, 10, 6, 7, 14), shape_box(10, 0, 10, 14, 7, 14)});
}

Shape grindstone_block(const ShapeStates& states) {
  const std::string_view face = states.get("face", "wall");
  Shape out = shape_of_boxes({shape_box(4, 4, 2, 12, 16, 14), shape_box(2, 7, 5, 4, 13, 11),
                              shape_box(12, 7, 5, 14, 13, 11), shape_box(2, 0, 6, 4, 7, 10),
                              shape_box(12, 0, 6, 14, 7, 10)});
  if (face == "ceiling") out = upside_down(out);
  // The lower side then lies south.
  if (face == "wall") out = turned(out, {Axis::x, Axis::z, Axis::y}, 4);
  return faced(out, states.get("facing"));
}

Shape bell_block(const ShapeStates& states) {
  Shape out = shape_of_boxes({shape_box(5, 6, 5, 11, 13, 11), shape_box(4, 4, 4, 12, 6, 12)});
  const std::string_view place = states.get("attachment", "floor");
  out = with_boxes(std::move(out),
                   place == "ceiling"       ? shape_of_boxes({shape_box(7, 13, 7, 9, 16, 9)})
                   : place == "single_wall" ? shape_of_boxes({shape_box(7, 13, 0, 9, 15, 13)})
                   : place == "double_wall" ? shape_of_boxes({shape_box(7, 13, 0, 9, 15, 16)})
                                            : shape_of_boxes({shape_box(0, 0, 6, 2, 16, 10),
                                                              shape_box(14, 0, 6, 16, 16, 10),
                                                              shape_box(2, 13, 7, 14, 15, 9)}));
  return faced(out, states.get("facing"));
}

Shape crop_block(const ShapeStates& states) {
  return plant_shape(2 + 2 * std::min(states.number("age", 0), 7U), 0);
}
Shape nether_wart_block(const ShapeStates& states) {
  return plant_shape(5 + 3 * std::min(states.number("age", 0), 3U), 0);
}
Shape berry_bush_block(const ShapeStates& states) {
  return plant_shape(states.number("age", 0) == 0 ? 8 : 16);
}
Shape torchflower_crop_block(const ShapeStates& states) {
  return plant_shape(6 + 4 * std::min(states.number("age", 0), 2U), 3);
}
Shape pitcher_crop_block(const ShapeStates& states) {
  return plant_shape(states.number("age", 0) == 0 ? 5 : 16);
}

/// The first rule that names a block holds, so exceptions precede the ends of names. A rule has a
/// kind (common/shapes/shape_kinds.hpp) or a function; with neither, the block is a cube.
struct BlockShapeRule {
  std::string_view names;  // as rule_names() reads them
  std::string_view kind = {};
  Shape (*make)(const ShapeStates&) = nullptr;
};
constexpr BlockShapeRule kBlockShapes[] = {
    {"sea_lantern jack_o_lantern"},
    {"*_stairs", "stairs"},
    {"*_slab", "slab"},
    {"*_fence_gate", "fence_gate"},
    {"*_fence", "fence"},
    {"*_pane *_bars", "pane"},
    {"*_wall", "wall"},
    {"*_trapdoor", "trapdoor"},
    {"*_door", "door"},
    {"pale_moss_carpet", "", pale_moss_carpet_block},
    {"*_carpet", "carpet"},
    {"*_pressure_plate", "pressure_plate"},
    {"*_button", "button"},
    {"lever", "lever"},
    {"ladder", "ladder"},
    {"vine glow_lichen sculk_vein resin_clump", "vine"},
    {"*wall_torch", "wall_torch"},
    {"torch *_torch", "torch"},
    {"lantern *_lantern", "lantern"},
    {"chain *_chain", "chain"},
    {"end_rod", "rod"},
    {"lightning_rod *_lightning_rod", "", lightning_rod_block},
    {"snow", "snow"},
    {"cactus", "cactus"},
    {"*_bed", "bed"},
    {"chest *_chest", "chest"},
    {"anvil chipped_anvil damaged_anvil", "anvil"},
    {"*_candle candle sea_pickle", "candle"},
    {"*_wall_skull *_wall_head", "wall_head"},
    {"piston_head", "", piston_head_block},
    {"*_skull *_head", "head"},
    {"*_wall_hanging_sign", "wall_hanging_sign"},
    {"*_hanging_sign", "hanging_sign"},
    {"*_wall_sign wall_sign", "wall_sign"},
    {"*_sign sign", "sign"},
    {"*_wall_banner", "wall_banner"},
    {"*_banner", "banner"},
    {"rail *_rail", "rail"},
    {"farmland dirt_path grass_path", "path"},
    {"piston sticky_piston", "", piston_block},
    {"small_amethyst_bud", "", small_amethyst_block},
    {"medium_amethyst_bud", "", medium_amethyst_block},
    {"large_amethyst_bud", "", large_amethyst_block},
    {"amethyst_cluster", "", amethyst_cluster_block},
    {"hopper", "", hopper_block},
    {"cake", "", cake_block},
    {"end_portal_frame", "", end_portal_frame_block},
    {"nether_portal", "", nether_portal_block},
    {"redstone_wire tripwire", "", wire_block},
    {"chorus_plant", "", chorus_plant_block},
    {"pointed_dripstone", "", dripstone_block},
    {"cocoa", "", cocoa_block},
    {"turtle_egg", "", turtle_egg_block},
    {"grindstone", "", grindstone_block},
    {"bell", "", bell_block},
    {"wheat carrots potatoes beetroots pumpkin_stem melon_stem", "", crop_block},
    {"nether_wart", "", nether_wart_block},
    {"sweet_berry_bush", "", berry_bush_block},
    {"torchflower_crop", "", torchflower_crop_block},
    {"pitcher_crop", "", pitcher_crop_block},
};

/// Returns the shape by the rules, or a cube.
Shape block_shape(std::string_view name, std::string_view states) {
  for (const BlockShapeRule& rule : kBlockShapes) {
    if (!rule_names(rule.names, name)) continue;
    if (rule.make != nullptr) return rule.make(ShapeStates(states));
    return shape_of_kind(rule.kind, states).value_or(Shape{});
  }
  for (const FixedShape& rule : kFixed) {
    if (!rule_names(rule.names, name)) continue;
    const Shape north{ShapeForm::boxes, {rule.boxes.begin(), rule.boxes.begin() + rule.count}};
    return faced(north, ShapeStates(states).get("facing"));
  }
  for (const PlantRule& rule : kPlants) {
    if (rule_names(rule.names, name)) return plant_shape(rule.height, rule.inset);
  }
  return {};
}

}  // namespace

std::optional<Shape> shape_of_minecraft_block(const ForeignBlock& given) {
  const ForeignBlock block = with_default_states(given);
  const std::string_view name = block.name;
  Shape out = block_shape(name.substr(name.find(':') + 1), block.states);
  if (out.is_cube()) return std::nullopt;
  return out;
}

}  // namespace runstone
