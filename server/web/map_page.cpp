#include "server/web/map_page.hpp"

#include <nlohmann/json.hpp>

#include "server/web/web_pages.hpp"

namespace runstone {

std::string map_page(const WebConfig& config) {
  if (config.world.empty()) {
    return html_page(config.title + ": map",
                     "<p>This gateway shows no map: its host has not turned it on.</p>\n"
                     "<p><a href=\"./\">Back to the world</a></p>\n");
  }
  const std::string title = html_text(config.title);
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         title +
         ": map</title>\n<link rel=\"stylesheet\" href=\"map.css\">\n"
         "<script src=\"map.js\" defer></script>\n</head>\n<body>\n"
         "<canvas id=\"map\" tabindex=\"0\" aria-label=\"Map of the world from above\"></canvas>\n"
         "<header><h1><a href=\"./\">" +
         title +
         "</a></h1><span id=\"place\"></span></header>\n"
         "<p id=\"words\" role=\"status\">"
         "<noscript>The map needs JavaScript. <a href=\"status\">The state of the server</a> "
         "does not.</noscript></p>\n"
         "<aside id=\"builders\" hidden><button id=\"close\" aria-label=\"Close\">&#215;</button>"
         "<h2></h2><ol></ol></aside>\n"
         "<nav id=\"zoom\"><button id=\"in\" aria-label=\"Nearer\">+</button>"
         "<button id=\"out\" aria-label=\"Farther\">&#8722;</button></nav>\n"
         "<footer id=\"time\" hidden><button id=\"play\">Play</button>"
         "<input id=\"moment\" type=\"range\" min=\"0\" max=\"0\" value=\"0\" step=\"1\" "
         "aria-label=\"Moment of the log\"><output id=\"when\"></output>"
         "<button id=\"now\">Now</button></footer>\n</body>\n</html>\n";
}

std::string map_players_json(const ServerStatus& server) {
  nlohmann::json out = nlohmann::json::array();
  for (const PlayerPlace& player : server.places)
    out.push_back({player.name, player.x, player.y, player.z});
  return out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace runstone
