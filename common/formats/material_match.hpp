// Material match: which materials of a world the materials of a build from elsewhere become.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "common/formats/build_head.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns the name of a world's row for a material of a build: its name, and its states in brackets
/// if it has any, unless the name has them (minecraft_material_name()): "default:stair[param2=3]".
/// A name of more than kMaterialNameBytesMax bytes is cut, and ends with '~' and 8 hexadecimal
/// digits of a hash of all of it, so that different materials have different names. Deterministic.
std::string world_name_of(const BuildMaterial& material);
/// Returns the material as a row for a world: it has world_name_of() as its name, and the shape
/// that the name says if it is a cube.
MaterialRow world_row_of(const BuildMaterial& material);

struct MaterialMatch {
  std::vector<std::optional<Material>> ids;  // by material of the build; nullopt: missing
  std::vector<std::size_t> missing;          // materials that the world lacks, ascending
};
/// Matches by names. A material that is empty becomes 0. Any other becomes the one with its
/// world_name_of(). Cost: O(materials * log table).
MaterialMatch match_by_name(std::span<const BuildMaterial> materials, const MaterialTable& table);

}  // namespace runstone
