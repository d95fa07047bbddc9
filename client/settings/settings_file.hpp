// Settings file: ClientSettings on disk. The functions wait for the disk.
#pragma once
#include <string>
#include <vector>

#include "client/settings/client_settings.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Returns $XDG_CONFIG_HOME/runstone/client.toml, otherwise ~/.config/runstone/client.toml, or an
/// empty text if neither variable is an absolute path.
std::string default_settings_file();
/// Returns $XDG_DATA_HOME/runstone/key, otherwise ~/.local/share/runstone/key, or an empty text.
std::string default_key_file();

struct LoadedSettings {
  ClientSettings settings;
  std::vector<std::string> warnings;  // lines for the player
};
/// Reads the file. A missing file gives the defaults. A file that is not TOML is renamed to
/// FILE.broken, which a warning says, and the defaults are used. A file that cannot be read stays
/// where it is, and a warning says why.
LoadedSettings load_settings(const std::string& file);
/// Replaces the file, and makes its folder. Fails with a line that begins with the file's name.
Result<void, std::string> save_settings(const std::string& file, const ClientSettings& settings);

}  // namespace runstone
