// The shapes that materials of other games' worlds have by their names.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/core/coords.hpp"
#include "common/core/shape.hpp"

namespace runstone {

/// Returns the shape that belongs to the name of a material, or nullopt for a cube and for a name
/// that no rule knows. check_shape() succeeds for each result. The names are
///   - those of blocks of Minecraft (block_of_minecraft_material()), such as
///     "minecraft:oak_stairs[facing=east]";
///   - those of nodes of Luanti, such as "stairs:slab_wood" and "stairs:stair_wood[param2=3]". The
///     param2 is a facedir or a direction to a wall, as the kind of node has it. A node without a
///     param2 has the param2 0. Fences and walls, which Luanti joins to their neighbours, are
///     posts; panes that are not flat are crosses. A node that only a rule of Minecraft knows, such
///     as "mcl_chests:chest[param2=3]", has the shape of its name, whatever its param2.
/// Names without a namespace have no shape: a table gives them one by its own keys. Cost: O(rules +
/// bytes).
std::optional<Shape> shape_of_material_name(std::string_view name);

/// Returns true if a name, with the states in it and beside it, is that of a node of Luanti,
/// although a rule of Minecraft may know its words: it has a param2, or it is of the games
/// MineClone2 and VoxeLibre. Such a node has no states of Minecraft. Other nodes may return false.
bool is_luanti_node(std::string_view name, std::string_view states = {});

/// Returns the name of the material for a node of Luanti with states, such as "param2=3". They are
/// in brackets behind the name of the node if they say how its shape lies, and are left out
/// otherwise.
std::string node_material_name(std::string_view node, std::string_view states);

/// Returns the name of the node of Luanti that is `name` turned (common/shapes/turned_shape.hpp):
/// it has another param2, which is the last of its states, and keeps the other states. Returns
/// nullopt if no rule names the node, and an empty text if no param2 makes it. Cost: O(rules +
/// bytes), and 24 shapes.
std::optional<std::string> turned_node_name(std::string_view name, std::array<Axis, 3> along,
                                            std::uint8_t flips);

}  // namespace runstone
