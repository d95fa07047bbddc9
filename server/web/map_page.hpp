// The page of the map: HTML, style sheet and script. They are written by hand and load nothing from
// elsewhere. docs/server-reference.md describes the requests that the script makes.
#pragma once
#include <string>
#include <string_view>

#include "server/web/server_status.hpp"
#include "server/web/web_config.hpp"

namespace runstone {

/// Returns the page of the map, or a page that says that there is none.
std::string map_page(const WebConfig& config);
std::string_view map_style();
std::string_view map_script();
/// Returns where the players are, as JSON: a list of [name, x, y, z].
std::string map_players_json(const ServerStatus& server);

}  // namespace runstone
