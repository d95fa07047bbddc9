// User folders: where programs of one user keep files, by the XDG base directory specification.
#pragma once
#include <string>

namespace runstone {

enum class UserFolder {
  config,  // $XDG_CONFIG_HOME, otherwise ~/.config: settings that people edit
  data,    // $XDG_DATA_HOME, otherwise ~/.local/share: keys and worlds
  state,   // $XDG_STATE_HOME, otherwise ~/.local/state: lists that the program keeps
  cache,   // $XDG_CACHE_HOME, otherwise ~/.cache: files that may be removed at any time
};

/// Returns the folder `runstone` in the user's folder of this kind, without making it. Returns an
/// empty text if neither the variable nor HOME has an absolute path. A relative path in the
/// variable is ignored, as the specification requires.
std::string user_folder(UserFolder kind);

}  // namespace runstone
