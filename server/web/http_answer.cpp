#include "server/web/http_answer.hpp"

#include <array>

#include "server/map/map_request.hpp"
#include "server/web/map_page.hpp"
#include "server/web/metrics_text.hpp"
#include "server/web/web_pages.hpp"

namespace runstone {
namespace {

struct Route {
  std::string_view path;
  bool shows_status;
  HttpAnswer (*answer)(const WebConfig&, const ServerStatus&,
                       const WebCounters&);  // null: kStatusPath
};

constexpr const char* kHtml = "text/html; charset=utf-8";

constexpr std::array<Route, 9> kRoutes = {{
    {"/", true,
     [](const WebConfig& config, const ServerStatus& server, const WebCounters& /*web*/) {
       return HttpAnswer{200, kHtml, world_page(config, server), "", false};
     }},
    {kStatusPath, true, nullptr},
    {"/metrics", true,
     [](const WebConfig& /*config*/, const ServerStatus& server, const WebCounters& web) {
       return HttpAnswer{200, "text/plain; version=0.0.4; charset=utf-8", metrics_text(server, web),
                         "", false};
     }},
    {"/style.css", false,
     [](const WebConfig& /*config*/, const ServerStatus& /*server*/, const WebCounters& /*web*/) {
       return HttpAnswer{200, "text/css; charset=utf-8", std::string(style_sheet()), "", true};
     }},
    {"/map", false,
     [](const WebConfig& config, const ServerStatus& /*server*/, const WebCounters& /*web*/) {
       return HttpAnswer{config.world.empty() ? 404U : 200U, kHtml, map_page(config), "", false};
     }},
    {"/map.css", false,
     [](const WebConfig& /*config*/, const ServerStatus& /*server*/, const WebCounters& /*web*/) {
       return HttpAnswer{200, "text/css; charset=utf-8", std::string(map_style()), "", true};
     }},
    {"/map.js", false,
     [](const WebConfig& /*config*/, const ServerStatus& /*server*/, const WebCounters& /*web*/) {
       return HttpAnswer{200, "text/javascript; charset=utf-8", std::string(map_script()), "",
                         true};
     }},
    {kMapPlayersPath, true,
     [](const WebConfig& /*config*/, const ServerStatus& server, const WebCounters& /*web*/) {
       return HttpAnswer{200, "application/json", map_players_json(server), "", false};
     }},
    {kPlayPath, false,
     [](const WebConfig& /*config*/, const ServerStatus& /*server*/, const WebCounters& /*web*/) {
       return plain_answer(426, "this address is for WebSockets");
     }},
}};

const Route* find_route(std::string_view target) {
  for (const Route& route : kRoutes) {
    if (route.path == path_of(target)) return &route;
  }
  return nullptr;
}

}  // namespace

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

bool shows_status(std::string_view target) {
  const Route* route = find_route(target);
  return route != nullptr && route->shows_status;
}

HttpAnswer answer_request(std::string_view method, std::string_view target, const WebConfig& config,
                          const ServerStatus& server, const WebCounters& web,
                          std::string_view recent_edits) {
  const Route* route = find_route(target);
  const bool is_map_data = route == nullptr && target.starts_with(kMapDataPath);
  if (route == nullptr && !is_map_data) return plain_answer(404, "there is no such page");
  if (method != "GET" && method != "HEAD") {
    HttpAnswer answer = plain_answer(405, "this page can only be read");
    answer.allow = "GET, HEAD";
    return answer;
  }
  if (is_map_data) return plain_answer(404, "this gateway shows no map");
  if (route->answer == nullptr)
    return {200, kHtml, status_page(config, server, web, recent_edits), "", false};
  return route->answer(config, server, web);
}

HttpAnswer plain_answer(unsigned status, std::string sentence) {
  return {status, "text/plain; charset=utf-8", std::move(sentence) + "\n", "", false};
}

const std::vector<std::pair<std::string, std::string>>& safety_headers() {
  static const std::vector<std::pair<std::string, std::string>> all = {
      {"Content-Security-Policy",
       "default-src 'none'; style-src 'self'; script-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; "
       "frame-ancestors 'none'"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Embedder-Policy", "require-corp"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
  };
  return all;
}

}  // namespace runstone
