// Names of Runstone's materials as names of nodes of Luanti, and back. Luanti allows a-z, A-Z, 0-9,
// _ and : in the name of a node.
//   - A name of these characters stays as it is, unless it is "ignore" or begins with "runstone:".
//   - Any other name gets the beginning "runstone:". A blank becomes "__", and every other byte than
//     a-z, A-Z and 0-9 becomes _ and two hexadecimal digits: "red bricks" is runstone:red__bricks, and
//     "minecraft:oak_stairs[facing=east]" is
//     runstone:minecraft_3aoak_5fstairs_5bfacing_3deast_5d.
// Different materials have different nodes, and each node leads back to its material.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace runstone {

/// Returns the name of the node for a material that is not empty. Cost: O(bytes).
std::string luanti_node_name(std::string_view material);

/// Returns the material of which luanti_node_name() made this name of a node, or nullopt if the
/// name has another beginning than "runstone:", or if luanti_node_name() makes it of no material
/// that validate_material() accepts. Cost: O(bytes).
std::optional<std::string> material_of_luanti_name(std::string_view node);

}  // namespace runstone
