// Player defaults: the options that the settings file and the kept identity give to a client if its
// command line does not set them.
#pragma once
#include <string>
#include <vector>

#include "client/app/options.hpp"
#include "client/input/key_map.hpp"
#include "client/settings/client_settings.hpp"

namespace runstone {

/// Returns the memory budget of a client that was told none: an eighth of the memory that the
/// machine or container has, from 256 to 1,024 MiB.
std::uint64_t automatic_memory_mib();
/// Sets the name, the key file, the view and the memory that the command line did not give. A name
/// that was never chosen is the user's name on this computer.
void apply_settings(const ClientSettings& settings, ClientOptions& options);

/// Returns the quality that the player chose, or nullopt if frames decide.
std::optional<Quality> quality_of(const ClientSettings& settings);

/// Returns the default keys with the changes of the settings. Adds a line to `warnings` for each
/// change that names no action or no key; the action keeps its default keys.
KeyMap key_map_of(const ClientSettings& settings, std::vector<std::string>& warnings);

/// Sets the key file to the kept one, if the command line did not give one, and makes its folder.
void use_kept_key(const ClientSettings& settings, ClientOptions& options);

}  // namespace runstone
