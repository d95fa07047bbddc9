// The import subcommand: makes a new Runstone world of a Luanti world.
#pragma once
#include <cstdint>
#include <ostream>
#include <string>

#include "common/core/result.hpp"

namespace runstone {

struct ImportRequest {
  std::string luanti;  // folder with map.sqlite
  std::string world;   // folder to be made
  std::uint16_t edge = 32;
  bool keep_all = false;
  bool palette = true;  // add the materials of the built-in table that the world lacks
};

/// Imports a world and prints a short report. The error is one line.
///   - The world is made as a NewFolder: an interrupted import leaves no incomplete world.
///   - The built-in materials that the world lacks are appended (append_palette()). If they do not
///     fit, the import fails and names the option that leaves them out.
///   - The source is read twice: a world pins its spawn when it is created, and the spawn is known
///     after the first read.
Result<void, std::string> import_world(const ImportRequest& request, std::ostream& out);

}  // namespace runstone
