// The names of materials that are turned or mirrored with a build. The states in the names of two
// materials tell that they are one block in two states. No table or file has a record of it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/core/coords.hpp"

namespace runstone {

/// Returns the name of the material that `name` becomes when a build is turned. `along` and `flips`
/// are those of turned() (common/shapes/turned_shape.hpp).
///   - Blocks of Minecraft change the states that say where a block faces and which sides it joins:
///     facing, axis, rotation, north to down, shape, hinge, half, type and others. If both blocks
///     have a shape, that of the result looks like the turned shape.
///   - Nodes of Luanti that have a shape change their param2. There is no such state for a node
///     that only a rule of Minecraft knows ("mcl_chests:chest[param2=3]"), unless its shape stays
///     the same. It never gets states of Minecraft (is_luanti_node()).
///   - Any other name changes the same states in its brackets. States that are not written stay so.
/// A name without such states is returned unchanged. Returns nullopt if there is no such state,
/// such as a torch upside down. The result is a name of 1 .. 64 bytes, but no table need have it.
/// Requires each axis once. Cost: O(rules + bytes), and some shapes.
std::optional<std::string> turned_material_name(std::string_view name, std::array<Axis, 3> along,
                                                std::uint8_t flips);

/// Returns a line for the person who turned a build, or an empty text if no material is stuck.
std::string stuck_notice(std::size_t stuck);

}  // namespace runstone
