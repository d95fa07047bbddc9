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
};

/// Imports a world and prints a short report. The error is one line.
///   - The world is made in the folder WORLD.importing, which is renamed when it is complete: an
///     interrupted import leaves no incomplete world.
///   - The source is read twice: a world pins its spawn when it is created, and the spawn is known
///     after the first read.
Result<void, std::string> import_world(const ImportRequest& request, std::ostream& out);

}  // namespace runstone
