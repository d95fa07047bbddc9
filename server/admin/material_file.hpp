// The file of the command `materials add`, and the texts about what it adds.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/edits/descriptor/added_materials.hpp"
#include "common/edits/descriptor/given_shapes.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// A larger file is refused.
inline constexpr std::size_t kMaterialFileBytesMax = std::size_t{1} << 20;

/// Reads a file of materials (parse_material_rows()). The error is one line. A pipe or a device is
/// an error, because reading it may never end. Blocks on the disk.
Result<std::vector<MaterialFileRow>, std::string> read_material_file(const std::string& file);

/// Returns text such as "35 wool_lime" for each row, from `first` on.
std::vector<std::string> material_lines(Material first, std::span<const MaterialRow> rows);
/// Returns these texts of the first eight rows in one line, for the command `log`.
std::string added_materials_text(const AddedMaterials& added);

/// Returns a text such as "oak_slab, oak_stairs and 3 more" with the names of the first eight
/// materials. Those that the table lacks are shown by their ids.
std::string material_names_text(const std::vector<Material>& ids, const MaterialTable& materials);
/// Returns the names of the materials of rows that a record gives.
template <class Rows>
std::string given_names_text(const Rows& rows, const MaterialTable& materials) {
  std::vector<Material> ids;
  for (const auto& row : rows) ids.push_back(row.material);
  return material_names_text(ids, materials);
}

}  // namespace runstone
