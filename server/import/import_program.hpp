// The import subcommand: a foreign world becomes a new Runstone world.
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

/// Makes the world beside its place and moves it there when it is complete, so that a broken-off import
/// leaves no half world. Prints a short report. The error is one line. Reads the source twice: a world pins
/// its spawn when it is made, and the spawn is known only when everything was read.
Result<void, std::string> import_world(const ImportRequest& request, std::ostream& out);

}  // namespace runstone
