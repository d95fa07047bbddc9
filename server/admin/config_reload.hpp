// The settings that a running server takes over when its configuration is read again.
#pragma once
#include <string>
#include <vector>

#include "server/admin/server_config.hpp"

namespace runstone {

/// Returns true if a running server takes over changes of the setting.
bool is_reloaded(const std::string& field);

struct ConfigReload {
  ServerConfig config;               // what runs now
  std::vector<std::string> taken;    // the settings that changed
  std::vector<std::string> waiting;  // that differ in the file and need a restart
  /// Returns "reloaded: log_level, operators; after a restart: listen", or "nothing has changed".
  std::string text() const;
};

/// Takes the settings of `read` that a running server may take over.
ConfigReload reload_config(const ServerConfig& running, const ServerConfig& read);

}  // namespace runstone
