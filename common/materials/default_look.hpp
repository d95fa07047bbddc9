// The look of a material whose row gives none. Worlds of earlier versions and of other programs
// have names and colours only. The client draws such materials with this look, and an import stores
// it.
#pragma once
#include <string_view>

#include "common/core/material_look.hpp"
#include "common/core/material_row.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the look for a name such as "oak_planks" or "default:meselamp": that of the first word
/// of the list in default_look.cpp which the name contains, otherwise MaterialLook{}. A liquid gets
/// no pattern, and a pattern of plants needs their shape (look_on_shape()). Cost: O(length of the
/// name).
MaterialLook default_look(std::string_view name, MaterialBody body, const Shape& shape);

/// Returns the look of a row: the given one, otherwise default_look().
MaterialLook look_of(const MaterialInfo& material);

}  // namespace runstone
