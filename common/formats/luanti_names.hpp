// Names of Runstone's materials as names of nodes of Luanti, and back. Luanti allows a-z, A-Z, 0-9,
// _ and : in the name of a node.
//   - A name of these characters stays as it is, unless it is "ignore" or begins with "runstone:".
//   - Any other name gets the beginning "runstone:". A blank becomes "__", and every other byte than
//     a-z, A-Z and 0-9 becomes _ and two hexadecimal digits: "red bricks" is runstone:red__bricks, and
//     "minecraft:oak_stairs[facing=east]" is
//     runstone:minecraft_3aoak_5fstairs_5bfacing_3deast_5d.
// Different materials have different nodes, and each node leads back to its material.
//   - A name that ends with "[param2=N]" is a node with this param2: "default:chest[param2=3]".
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace runstone {

/// Returns the name of the node for a material that is not empty. Cost: O(bytes).
std::string luanti_node_name(std::string_view material);

/// The state of a node of Luanti that a number is: its direction, its level or its colour. A state
/// of 0 is none.
inline constexpr std::string_view kLuantiParam = "param2=";

/// A material as a node of Luanti.
struct LuantiNode {
  std::string name;
  std::uint8_t param2 = 0;
  friend bool operator==(const LuantiNode&, const LuantiNode&) = default;
};

/// Returns the number of a state "param2=N", which is 1 to 255 without leading zeros, or nullopt.
std::optional<std::uint8_t> luanti_param2(std::string_view state);

/// Returns the material without "[param2=N]" at its end, and the N. Without such an end, it is the
/// material and 0.
LuantiNode split_luanti_param2(std::string_view material);

/// Returns the node for a material that is not empty: split_luanti_param2() with the name of
/// luanti_node_name(). Cost: O(bytes).
LuantiNode luanti_node_of(std::string_view material);

/// Returns the material of which luanti_node_name() made this name of a node, or nullopt if the
/// name has another beginning than "runstone:", or if luanti_node_name() makes it of no material
/// that validate_material() accepts. Cost: O(bytes).
std::optional<std::string> material_of_luanti_name(std::string_view node);

}  // namespace runstone
