// The pages of world, state and map. All but that of the map are plain HTML without scripts, and
// load nothing but the style sheet of the gateway.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "server/web/server_status.hpp"
#include "server/web/web_config.hpp"
#include "server/web/web_counters.hpp"

namespace runstone {

/// Returns the text with <, >, &, " and ' written as entities, for HTML between and within tags.
std::string html_text(std::string_view text);

/// Returns a page with this title, of which `body` is HTML.
std::string html_page(const std::string& title, const std::string& body);

/// Returns the page of the world: its name, who is there, and how to join.
/// `has_client`: the gateway has the client for browsers.
std::string world_page(const WebConfig& config, bool has_client, const ServerStatus& server);
/// Returns the page of a gateway with several servers: their worlds, and who is there.
std::string worlds_page(const WebConfig& config, std::span<const WorldStatus> worlds);
/// Returns the page of the state of such a gateway.
std::string gateway_status_page(const WebConfig& config, std::span<const WorldStatus> worlds,
                                const WebCounters& web);
/// Returns the page of the state of server and gateway. `recent_edits`: JSON of the map's service,
/// a list of edits with time, author and what; empty or anything else: none are shown.
/// `is_one_of_several`: the gateway has a page of its own.
std::string status_page(const WebConfig& config, const ServerStatus& server, const WebCounters& web,
                        std::string_view recent_edits = {}, bool is_one_of_several = false);
/// Returns the page of the map, or a page that says that there is none.
std::string map_page(const WebConfig& config);
/// Returns where the players are on the map, as JSON: a list of [name, x, y, z].
std::string map_players_json(const ServerStatus& server);
/// Returns the border of the world: {"circle": [x, z, radius]}, {"box": [x, z, x, z]} with the
/// column behind the last at the end, or {} if there is none.
std::string map_border_json(const ServerStatus& server);

}  // namespace runstone
