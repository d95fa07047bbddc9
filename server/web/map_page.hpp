// The page of the map, and where the players on it are.
#pragma once
#include <string>

#include "server/web/server_status.hpp"
#include "server/web/web_config.hpp"

namespace runstone {

/// Returns the page of the map, or a page that says that there is none.
std::string map_page(const WebConfig& config);
/// Returns where the players are, as JSON: a list of [name, x, y, z].
std::string map_players_json(const ServerStatus& server);

}  // namespace runstone
