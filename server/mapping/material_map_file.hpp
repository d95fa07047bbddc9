// The TOML file of a MaterialMap:
//   [materials]
//   "minecraft:oak_planks" = "planks"
//   "default:*" = "stone"
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "common/core/text_error.hpp"
#include "common/formats/material_map.hpp"

namespace runstone {

inline constexpr std::size_t kMaterialMapFileBytesMax = std::size_t{1} << 20;

/// Reads the text of a file. `file` is only for messages. Fails with the line and the key if the
/// text is no TOML, has another key than `materials`, has no row, or if MaterialMap::of() refuses a
/// row.
Result<MaterialMap, TextError> parse_material_map(std::string_view toml, std::string_view file);

/// Reads a file. The error is one line that begins with the name of the file. Fails if
/// parse_material_map() does, if the file has more than kMaterialMapFileBytesMax bytes, or if it is
/// a pipe or a device. Blocks on the disk.
Result<MaterialMap, std::string> read_material_map(const std::string& file);

/// Returns a line about the rows of the file that applied to no material, or an empty text.
std::string unused_rows_notice(const std::string& file, const MaterialMap& map,
                               const AppliedRows& applied);

}  // namespace runstone
