#include "server/web/map_page.hpp"

#include <nlohmann/json.hpp>

#include "server/web/page_files.hpp"
#include "server/web/web_pages.hpp"

namespace runstone {

std::string map_page(const WebConfig& config) {
  if (config.world.empty()) {
    return html_page(config.title + ": map",
                     "<p>This gateway shows no map: its host has not turned it on.</p>\n"
                     "<p><a href=\"./\">Back to the world</a></p>\n");
  }
  constexpr std::string_view kMark = "{title}";
  const std::string title = html_text(config.title);
  std::string out(map_html());
  for (std::size_t at = out.find(kMark); at != std::string::npos;
       at = out.find(kMark, at + title.size()))
    out.replace(at, kMark.size(), title);
  return out;
}

std::string map_players_json(const ServerStatus& server) {
  nlohmann::json out = nlohmann::json::array();
  for (const PlayerPlace& player : server.places)
    out.push_back({player.name, player.x, player.y, player.z});
  return out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace runstone
