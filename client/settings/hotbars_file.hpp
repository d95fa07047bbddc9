// Hotbars file: the hotbars that a player has kept under names, in a TOML file. The functions wait
// for the disk.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

/// Names of materials by slot, by the name of the hotbar.
using HotbarRows = std::map<std::string, std::vector<std::string>>;

/// Returns $XDG_STATE_HOME/runstone/hotbars.toml, otherwise the one in ~/.local/state, or an empty
/// text if neither variable is an absolute path.
std::string default_hotbars_file();
/// Returns the hotbars of the file. Rows that are wrong are left out. A file that is missing, cannot
/// be read or is no TOML has none; the last one is kept as FILE.broken.
HotbarRows load_hotbars(const std::string& file);
/// Replaces the file. Fails with a line that begins with the file's name.
Result<void, std::string> save_hotbars(const std::string& file, const HotbarRows& hotbars);

}  // namespace runstone
