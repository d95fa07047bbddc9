// The answer of the command `materials`.
#pragma once
#include <string>
#include <string_view>

#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the names of the materials that contain `part`, one per line, in the order of their ids.
/// The material "air" is listed too: edits may set it. A last line counts the names beyond 1000.
std::string material_list(const MaterialTable& materials, std::string_view part);

}  // namespace runstone
