// The import subcommand: makes a new Runstone world of a Luanti or Minecraft world, or of a file with a
// build (docs/formats.md).
#pragma once
#include <cstdint>
#include <ostream>
#include <string>

#include "common/build_files/model_reading.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"

namespace runstone {

enum class ImportKind : std::uint8_t { luanti, minecraft, file };

struct ImportRequest {
  ImportKind kind = ImportKind::luanti;
  std::string source;  // the folder of a world; a world folder or region file; a file with a build
  std::string world;   // folder to be made
  VoxelPos at;         // of the lowest corner of a build
  std::uint16_t edge = 32;
  bool keep_all = false;
  bool progress = false;  // print progress on standard error even if it is no terminal
  bool palette = true;    // add the materials of the built-in table that the world lacks
  std::string colours;    // of a file that is a height map: the PNG with its colours; empty: none
  ModelReading model;     // of a file that is a model
  std::string map;        // TOML file that chooses materials (material_map_file.hpp); empty: none
  std::string textures;   // folder of pictures (texture_import.hpp); empty: none
};

/// Imports a world and prints a short report. The error is one line.
///   - The world is made as a NewFolder: an interrupted import leaves no incomplete world.
///   - The built-in materials that the world lacks are appended (append_palette()). If they do not
///     fit, the import fails and names the option that leaves them out.
///   - Rows of the map of materials that applied to none are named in the report.
///   - The source is read twice: a world pins its spawn when it is created, and the spawn is known
///     after the first read.
Result<void, std::string> import_world(const ImportRequest& request, std::ostream& out);

}  // namespace runstone
