// Local worlds: the worlds that a player keeps on this computer. Each one is a folder of a server,
// named for the world.
#pragma once
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

struct LocalWorld {
  std::string name;
  std::string folder;
  TimeUs changed_us = 0;  // UTC, when its database was last written
};

/// Returns $XDG_DATA_HOME/runstone/worlds, otherwise the one in ~/.local/share, or an empty text if
/// neither variable is an absolute path.
std::string local_worlds_folder();

/// Fails with a sentence if a new world may not have this name. A name has 1 to 32 bytes, letters,
/// digits, blanks, hyphens and underscores, and a blank neither first nor last.
Result<void, std::string> check_world_name(const std::string& name);

/// Returns the worlds in `folder`, the one that changed last first. Folders without a world are
/// left out. Returns none if the folder is missing.
std::vector<LocalWorld> list_local_worlds(const std::string& folder);
/// Returns true if the folder holds a world.
bool holds_world(const std::string& folder);

}  // namespace runstone
