// The built-in kinds of shapes: slabs, stairs, fences and the like. A material's states say how a
// kind lies: facing=north|east|south|west (-z, +x, +z, -x), half=bottom|top, and others
// (docs/materials.md lists them).
#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "common/core/shape.hpp"

namespace runstone {

/// Returns the names of the kinds, ascending.
std::span<const std::string_view> shape_kinds();

/// Returns the shape of a kind with these states ("facing=east,half=top"); states that are missing
/// or unknown have their defaults. Returns a cube if the states make one, such as a slab of
/// type=double, and nullopt for an unknown kind. check_shape() succeeds for each shape that is no
/// cube. Cost: O(kinds + bytes).
std::optional<Shape> shape_of_kind(std::string_view kind, std::string_view states);

}  // namespace runstone
