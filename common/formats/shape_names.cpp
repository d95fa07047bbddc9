#include "common/formats/shape_names.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "common/core/material_row.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_shapes.hpp"
#include "common/formats/minecraft_states.hpp"
#include "common/shapes/shape_kinds.hpp"
#include "common/shapes/shape_states.hpp"
#include "common/shapes/turned_shape.hpp"

namespace runstone {
namespace {

/// How the param2 of a node turns it.
enum class NodeTurn : std::uint8_t { none, facedir, wall };

struct NodeShapeRule {
  std::string_view names;  // as rule_names() reads them
  NodeTurn turn = NodeTurn::none;
  // As the node lies with a facedir of 0, whose front is +z, or with its wall at +z. A node without
  // boxes and without a plant is a cube.
  std::array<ShapeBox, 4> boxes{};
  std::size_t box_count = 0;
  std::uint8_t plant_height = 0;
};

template <class... Boxes>
constexpr NodeShapeRule boxed(std::string_view names, NodeTurn turn, Boxes... boxes) {
  return {names, turn, {boxes...}, sizeof...(boxes), 0};
}
constexpr NodeShapeRule planted(std::string_view names, std::uint8_t height) {
  return {names, NodeTurn::none, {}, 0, height};
}

constexpr ShapeBox kLowHalf = shape_box(0, 0, 0, 16, 8, 16);

/// The first rule that names a node holds.
constexpr NodeShapeRule kNodeShapes[] = {
    {"*:snowblock *:slab_*_double"},
    boxed("*:slab_*_top", NodeTurn::facedir, shape_box(0, 8, 0, 16, 16, 16)),
    boxed("*:slab_*", NodeTurn::facedir, kLowHalf),
    boxed("*:stair_inner_* *:stair_*_inner", NodeTurn::facedir, kLowHalf,
          shape_box(0, 8, 8, 16, 16, 16), shape_box(0, 8, 0, 8, 16, 8)),
    boxed("*:stair_outer_* *:stair_*_outer", NodeTurn::facedir, kLowHalf,
          shape_box(0, 8, 8, 8, 16, 16)),
    boxed("*:stair_*", NodeTurn::facedir, kLowHalf, shape_box(0, 8, 8, 16, 16, 16)),
    boxed("default:torch_wall *:torch_wall", NodeTurn::wall, shape_box(7, 3, 14, 9, 8, 16),
          shape_box(7, 6, 12, 9, 13, 14)),
    boxed("default:torch_ceiling *:torch_ceiling", NodeTurn::none, shape_box(7, 6, 7, 9, 16, 9)),
    boxed("default:torch *:torch", NodeTurn::none, shape_box(7, 0, 7, 9, 10, 9)),
    boxed("default:ladder* *:ladder_wood *:ladder_steel mcl_core:ladder", NodeTurn::wall,
          shape_box(0, 0, 15, 16, 16, 16)),
    boxed("default:sign_wall* signs:sign_wall*", NodeTurn::wall, shape_box(1, 4, 15, 15, 12, 16)),
    boxed("default:fence_rail_*", NodeTurn::none, shape_box(0, 3, 7, 16, 5, 9),
          shape_box(0, 11, 7, 16, 13, 9), shape_box(7, 3, 0, 9, 5, 16),
          shape_box(7, 11, 0, 9, 13, 16)),
    boxed("default:fence_* default:mese_post_light*", NodeTurn::none,
          shape_box(6, 0, 6, 10, 16, 10)),
    boxed("doors:gate_*_open", NodeTurn::facedir, shape_box(0, 4, 7, 2, 16, 9),
          shape_box(14, 4, 7, 16, 16, 9), shape_box(0, 6, 9, 2, 14, 15),
          shape_box(14, 6, 9, 16, 14, 15)),
    boxed("doors:gate_*_closed", NodeTurn::facedir, shape_box(0, 4, 7, 2, 16, 9),
          shape_box(14, 4, 7, 16, 16, 9), shape_box(2, 6, 7, 14, 8, 9),
          shape_box(2, 12, 7, 14, 14, 9)),
    boxed("doors:trapdoor*_open xpanes:trapdoor*_open", NodeTurn::facedir,
          shape_box(0, 0, 14, 16, 16, 16)),
    boxed("doors:trapdoor* xpanes:trapdoor*", NodeTurn::facedir, shape_box(0, 0, 0, 16, 2, 16)),
    boxed("doors:*_a doors:*_b doors:*_c doors:*_d xpanes:door_*", NodeTurn::facedir,
          shape_box(0, 0, 0, 16, 16, 2)),
    boxed("xpanes:*_flat", NodeTurn::facedir, shape_box(0, 0, 7, 16, 16, 9)),
    boxed("xpanes:*", NodeTurn::none, shape_box(0, 0, 7, 16, 16, 9), shape_box(7, 0, 0, 9, 16, 7),
          shape_box(7, 0, 9, 9, 16, 16)),
    boxed("walls:*", NodeTurn::none, shape_box(4, 0, 4, 12, 16, 12)),
    boxed("default:snow", NodeTurn::none, shape_box(0, 0, 0, 16, 4, 16)),
    boxed("default:rail carts:*rail", NodeTurn::none, shape_box(0, 0, 0, 16, 1, 16)),
    boxed("beds:*_bottom beds:*_top", NodeTurn::facedir, shape_box(0, 0, 0, 16, 9, 16)),
    boxed("carpets:* *:carpet_*", NodeTurn::none, shape_box(0, 0, 0, 16, 1, 16)),
    boxed("flowers:waterlily*", NodeTurn::none, shape_box(0, 0, 0, 16, 1, 16)),
    planted("flowers:mushroom_*", 6),
    planted("flowers:*", 11),
    planted("default:grass_1 default:dry_grass_1 default:marram_grass_1 default:fern_1", 5),
    planted("default:grass_2 default:dry_grass_2 default:marram_grass_2 default:fern_2", 8),
    planted("default:grass_3 default:dry_grass_3 default:marram_grass_3 default:fern_3", 11),
    planted("default:grass_4 default:dry_grass_4", 13),
    planted("default:grass_* default:dry_grass_* default:junglegrass default:papyrus "
            "default:*sapling default:dry_shrub default:*bush_stem default:sand_with_kelp_top",
            16),
    planted("farming:wheat_1 farming:cotton_1 farming:wheat_2 farming:cotton_2", 5),
    planted("farming:wheat_3 farming:cotton_3 farming:wheat_4 farming:cotton_4", 9),
    planted("farming:wheat_* farming:cotton_*", 15),
    planted("fire:*flame", 16),
    planted("vessels:glass_bottle vessels:drinking_glass vessels:steel_bottle", 8),
    // These are whole cubes, unlike blocks of Minecraft with the same name.
    {"default:*"},
};

/// Turns by quarters in the plane of axes a and b: a quarter takes +a to +b.
Shape turned_in_plane(const Shape& shape, Axis a, Axis b, unsigned quarters) {
  std::array<Axis, 3> along = {Axis::x, Axis::y, Axis::z};
  const auto bit = [](Axis axis) { return 1U << static_cast<unsigned>(axis); };
  if (quarters % 2 != 0)
    std::swap(along[static_cast<std::size_t>(a)], along[static_cast<std::size_t>(b)]);
  const unsigned flips = quarters % 4 == 1   ? bit(a)
                         : quarters % 4 == 2 ? bit(a) | bit(b)
                         : quarters % 4 == 3 ? bit(b)
                                             : 0;
  return turned(shape, along, static_cast<std::uint8_t>(flips));
}

/// Turns a node as a facedir of 0 .. 23 does: facedir / 4 is the axis to which its top points (+y,
/// +z, -z, +x, -x, -y), and facedir % 4 its turn about that axis. Other values are 0.
Shape turned_by_facedir(const Shape& shape, unsigned facedir) {
  if (facedir >= 24) return shape;
  const unsigned turn = facedir % 4, back = (4 - turn) % 4;
  constexpr Axis x = Axis::x, y = Axis::y, z = Axis::z;
  switch (facedir / 4) {
    case 1:
      return turned_in_plane(turned_in_plane(shape, y, z, 1), x, y, turn);
    case 2:
      return turned_in_plane(turned_in_plane(shape, y, z, 3), x, y, back);
    case 3:
      return turned_in_plane(turned_in_plane(shape, x, y, 3), y, z, turn);
    case 4:
      return turned_in_plane(turned_in_plane(shape, x, y, 1), y, z, back);
    case 5:
      return turned_in_plane(turned_in_plane(shape, x, y, 2), x, z, turn);
    default:
      return turned_in_plane(shape, x, z, back);
  }
}

/// Turns what hangs on a wall at +z to the wall of a param2: 0 +y, 1 -y, 2 +x, 3 -x, 4 +z, 5 -z.
/// Other values are +z.
Shape turned_to_wall(const Shape& shape, unsigned wall) {
  switch (wall) {
    case 0:
      return turned_in_plane(shape, Axis::y, Axis::z, 3);
    case 1:
      return turned_in_plane(shape, Axis::y, Axis::z, 1);
    case 2:
      return turned_in_plane(shape, Axis::x, Axis::z, 3);
    case 3:
      return turned_in_plane(shape, Axis::x, Axis::z, 1);
    case 5:
      return turned_in_plane(shape, Axis::x, Axis::z, 2);
    default:
      return shape;
  }
}

std::string_view node_of_name(std::string_view name) { return name.substr(0, name.find('[')); }

bool has_param2(std::string_view name) {
  return !ShapeStates(states_in_name(name)).get("param2").empty();
}

unsigned param2_of_name(std::string_view name) {
  return ShapeStates(states_in_name(name)).number("param2", 0);
}

/// Returns the name of a node with its states, but with this param2 as the last of them. A param2
/// of 0 is no state.
std::string with_param2(std::string_view name, unsigned param2) {
  std::string states;
  const auto append = [&](std::string_view one) {
    states.append(states.empty() ? "" : ",").append(one);
  };
  for (std::string_view left = states_in_name(name); !left.empty();) {
    const std::size_t end = std::min(left.find(','), left.size());
    const std::string_view one = left.substr(0, end);
    if (!one.starts_with("param2=")) append(one);
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  if (param2 != 0) append("param2=" + std::to_string(param2));
  std::string out(node_of_name(name));
  return states.empty() ? out : out + '[' + states + ']';
}

const NodeShapeRule* node_rule(std::string_view name) {
  const std::string_view node = node_of_name(name);
  const auto* rule =
      std::find_if(std::begin(kNodeShapes), std::end(kNodeShapes),
                   [&](const NodeShapeRule& one) { return rule_names(one.names, node); });
  return rule == std::end(kNodeShapes) ? nullptr : rule;
}

/// Returns the shape of a node, or a cube.
Shape shape_of_node(const NodeShapeRule& rule, unsigned param2) {
  if (rule.plant_height != 0) return plant_shape(rule.plant_height);
  const Shape shape{ShapeForm::boxes, {rule.boxes.begin(), rule.boxes.begin() + rule.box_count}};
  // Bits above these are the colour.
  if (rule.turn == NodeTurn::facedir) return turned_by_facedir(shape, param2 % 32);
  return rule.turn == NodeTurn::wall ? turned_to_wall(shape, param2 % 8) : shape;
}

}  // namespace

std::optional<Shape> shape_of_material_name(std::string_view name) {
  if (name.empty() || name.find(':') == std::string_view::npos) return std::nullopt;
  if (!name.starts_with("minecraft:")) {
    if (const NodeShapeRule* rule = node_rule(name)) {
      Shape out = shape_of_node(*rule, param2_of_name(name));
      if (out.is_cube()) return std::nullopt;
      return out;
    }
    // No block of Minecraft has a param2. The name of its node has the shape.
    if (has_param2(name)) name = node_of_name(name);
  }
  const auto block = block_of_minecraft_material(name);
  return block ? shape_of_minecraft_block(*block) : std::nullopt;
}

bool is_luanti_node(std::string_view name, std::string_view states) {
  return name.starts_with("mcl_") || has_param2(name) || !ShapeStates(states).get("param2").empty();
}

std::string node_material_name(std::string_view node, std::string_view states) {
  std::string whole(node);
  whole.append("[").append(states).append("]");
  if (states.empty() || whole.size() > kMaterialNameBytesMax) return std::string(node);
  const auto lying = shape_of_material_name(whole);
  return lying && lying != shape_of_material_name(node) ? whole : std::string(node);
}

std::optional<std::string> turned_node_name(std::string_view name, std::array<Axis, 3> along,
                                            std::uint8_t flips) {
  const NodeShapeRule* rule = name.starts_with("minecraft:") ? nullptr : node_rule(name);
  if (rule == nullptr) return std::nullopt;
  const unsigned before = param2_of_name(name);
  const bool stands = along[1] == Axis::y && (flips & 2) == 0;
  if (rule->plant_height != 0) return stands ? std::string(name) : std::string();
  const Shape wanted = turned(shape_of_node(*rule, before), along, flips);
  if (look_alike(shape_of_node(*rule, before), wanted)) return std::string(name);
  const unsigned bits = rule->turn == NodeTurn::facedir ? 32 : 8;
  const unsigned count = rule->turn == NodeTurn::facedir ? 24
                         : rule->turn == NodeTurn::wall  ? 6
                                                         : 0;
  for (unsigned turn = 0; turn < count; ++turn) {
    if (!look_alike(shape_of_node(*rule, turn), wanted)) continue;
    return with_param2(name, before / bits * bits + turn);
  }
  return std::string();
}

}  // namespace runstone
