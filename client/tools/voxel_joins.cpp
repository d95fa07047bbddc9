#include "client/tools/voxel_joins.hpp"

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "client/tools/aim.hpp"
#include "common/formats/material_family.hpp"
#include "common/shapes/shape_faces.hpp"

namespace runstone {
namespace {

enum class JoinKind : std::uint8_t { none, fence, pane, wall };

constexpr std::array<std::pair<Direction, std::string_view>, 4> kJoinSides = {
    {{Direction::neg_z, "north"},
     {Direction::pos_x, "east"},
     {Direction::pos_z, "south"},
     {Direction::neg_x, "west"}}};

bool ends_with_word(std::string_view path, std::string_view word) {
  return path.ends_with(word) &&
         (path.size() == word.size() || path[path.size() - word.size() - 1] == '_');
}

JoinKind join_kind(std::string_view path) {
  if (ends_with_word(path, "fence")) return JoinKind::fence;
  if (ends_with_word(path, "pane") || ends_with_word(path, "bars")) return JoinKind::pane;
  return ends_with_word(path, "wall") ? JoinKind::wall : JoinKind::none;
}

/// The kind of a material. Nodes of Luanti have no states by which they join.
JoinKind join_kind_of(Material material, const MaterialTable& table) {
  if (material == kEmpty || !table.knows(material)) return JoinKind::none;
  const std::string_view name = table[material].name;
  const std::string_view family = name.substr(0, name.find_first_of("[{~"));
  const JoinKind kind = join_kind(family.substr(family.find(':') + 1));
  return kind != JoinKind::none && is_shaped_node(name) ? JoinKind::none : kind;
}

bool is_of_nether_brick(std::string_view name) {
  return name.find("nether_brick") != std::string_view::npos;
}

/// Returns true if a material joins its neighbour in this direction.
bool joins(Material material, std::optional<Material> neighbour, Direction to,
           const MaterialTable& table) {
  if (!neighbour || *neighbour == kEmpty || !table.knows(*neighbour)) return false;
  const MaterialInfo& info = table[*neighbour];
  const JoinKind kind = join_kind_of(material, table), other = join_kind_of(*neighbour, table);
  if (other != JoinKind::none) {
    if (kind != JoinKind::fence) return other != JoinKind::fence;
    return other == kind &&
           is_of_nether_brick(table[material].name) == is_of_nether_brick(info.name);
  }
  const MaterialStates states = states_of_material(info.name);
  if (ends_with_word(states.path(), "fence_gate")) {
    const bool is_along_x = states.get("facing") == "north" || states.get("facing") == "south";
    return kind != JoinKind::pane && is_along_x == (axis_of(to) == Axis::x);
  }
  if (info.body != MaterialBody::solid || info.visibility == Visibility::empty) return false;
  if (info.shape.is_cube()) return !states.path().ends_with("leaves");
  return ShapeFaces(info.shape).side(opposite(to)).all();
}

/// Sets the state of one side.
void set_side(MaterialStates& states, JoinKind kind, std::string_view side, bool is_joined) {
  std::string& value = states.states[std::string(side)];
  if (kind != JoinKind::wall) {
    value = is_joined ? "true" : "false";
  } else if (!is_joined) {
    value = "none";
  } else if (value != "tall") {
    value = "low";
  }
}

/// A wall that goes straight on has no post.
void set_post(MaterialStates& states) {
  const auto is_joined = [&](std::string_view side) {
    return states.get(side) != "none" && states.get(side) != "false";
  };
  const bool north = is_joined("north"), south = is_joined("south"), east = is_joined("east"),
             west = is_joined("west");
  const bool is_straight = north == south && east == west && north != east;
  states.states["up"] = is_straight ? "false" : "true";
}

Material member_with(Material material, const MaterialStates& states, const MaterialTable& table) {
  const MaterialStates before = states_of_material(table[material].name);
  if (before.states == states.states) return material;
  return nearest_member(table, states).value_or(material);
}

}  // namespace

Material joined_material(VoxelPos at, Material material, const MaterialTable& table,
                         const VoxelReader& voxels) {
  const JoinKind kind = join_kind_of(material, table);
  if (kind == JoinKind::none) return material;
  MaterialStates states = states_of_material(table[material].name);
  for (const auto& [direction, side] : kJoinSides) {
    const auto neighbour = voxels(moved(at, direction, 1));
    set_side(states, kind, side, joins(material, neighbour, direction, table));
  }
  if (kind == JoinKind::wall) set_post(states);
  return member_with(material, states, table);
}

std::vector<EditDescriptor> joined_edits(VoxelPos at, Material material, const MaterialTable& table,
                                         const VoxelReader& voxels) {
  const Material placed = joined_material(at, material, table, voxels);
  std::vector<EditDescriptor> out = {{SetVoxel{at}, {}, placed}};
  for (const auto& [direction, side] : kJoinSides) {
    const VoxelPos place = moved(at, direction, 1);
    const auto neighbour = voxels(place);
    if (!neighbour) continue;
    const JoinKind kind = join_kind_of(*neighbour, table);
    if (kind == JoinKind::none) continue;
    const Direction back = opposite(direction);
    MaterialStates states = states_of_material(table[*neighbour].name);
    for (const auto& [other, name] : kJoinSides) {
      if (other == back) set_side(states, kind, name, joins(*neighbour, placed, back, table));
    }
    if (kind == JoinKind::wall) set_post(states);
    const Material now = member_with(*neighbour, states, table);
    if (now != *neighbour)
      out.push_back({SetVoxel{place}, {MaskKind::only_material, *neighbour}, now});
  }
  return out;
}

}  // namespace runstone
