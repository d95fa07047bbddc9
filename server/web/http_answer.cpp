#include "server/web/http_answer.hpp"

#include <array>
#include <memory>

#include "server/map/map_request.hpp"
#include "server/web/metrics_text.hpp"
#include "server/web/page_files.hpp"
#include "server/web/web_pages.hpp"
#include "server/web/web_world.hpp"

namespace runstone {
namespace {

struct Route {
  std::string_view path;
  bool shows_status;
  HttpAnswer (*answer)(const PageContents&);
};

constexpr const char* kHtml = "text/html; charset=utf-8";
constexpr std::string_view kMetricsPath = "/metrics", kStylePath = "/style.css";

HttpAnswer fixed(std::string type, std::string_view body) {
  return {200, std::move(type), std::string(body), "", HttpCaching::an_hour};
}

HttpAnswer metrics_answer(std::span<const WorldStatus> worlds, const WebCounters& web) {
  return {200, "text/plain; version=0.0.4; charset=utf-8", metrics_text(worlds, web)};
}

constexpr std::array<Route, 10> kRoutes = {{
    {"/", true,
     [](const PageContents& in) {
       return HttpAnswer{200, kHtml, world_page(in.config, !in.client.empty(), in.server)};
     }},
    {kStatusPath, true,
     [](const PageContents& in) {
       return HttpAnswer{
           200, kHtml,
           status_page(in.config, in.server, in.web, in.recent_edits, !in.world_name.empty())};
     }},
    {kMetricsPath, true,
     [](const PageContents& in) {
       if (!in.world_name.empty())
         return plain_answer(404, "the numbers of all worlds are at /metrics");
       const std::array<WorldStatus, 1> world = {
           {{"", in.config.title, {std::shared_ptr<void>(), &in.server}}}};
       return metrics_answer(world, in.web);
     }},
    {kStylePath, false,
     [](const PageContents& /*in*/) { return fixed("text/css; charset=utf-8", style_css()); }},
    {"/map", false,
     [](const PageContents& in) {
       HttpAnswer page{in.config.world.empty() ? 404U : 200U, kHtml, map_page(in.config)};
       page.scripts = PageScripts::own;
       return page;
     }},
    {"/map.css", false,
     [](const PageContents& /*in*/) { return fixed("text/css; charset=utf-8", map_css()); }},
    {"/map.js", false,
     [](const PageContents& /*in*/) { return fixed("text/javascript; charset=utf-8", map_js()); }},
    {kMapPlayersPath, true,
     [](const PageContents& in) {
       return HttpAnswer{200, "application/json", map_players_json(in.server)};
     }},
    {kMapBorderPath, true,
     [](const PageContents& in) {
       return HttpAnswer{200, "application/json", map_border_json(in.server)};
     }},
    {kPlayPath, false,
     [](const PageContents& /*in*/) {
       return plain_answer(426, "this address is for WebSockets");
     }},
}};

const Route* find_route(std::string_view target) {
  for (const Route& route : kRoutes) {
    if (route.path == path_of(target)) return &route;
  }
  return nullptr;
}

bool is_read(const HttpRequest& request) {
  return request.method == "GET" || request.method == "HEAD";
}

HttpAnswer only_read_answer() {
  HttpAnswer answer = plain_answer(405, "this page can only be read");
  answer.allow = "GET, HEAD";
  return answer;
}

HttpAnswer file_answer(const ClientFile& file, const HttpRequest& request) {
  HttpAnswer answer;
  answer.type = file.type;
  answer.caching = HttpCaching::while_unchanged;
  answer.scripts = PageScripts::client;
  answer.tag = file.tag;
  if (request.if_none_match.find(file.tag) != std::string_view::npos) {
    answer.status = 304;
    return answer;
  }
  answer.encoding = file.encoding;
  answer.shared = file.bytes;
  return answer;
}

}  // namespace

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

bool shows_status(std::string_view target) {
  const Route* route = find_route(target);
  return route != nullptr && route->shows_status;
}

HttpAnswer answer_request(const HttpRequest& request, const PageContents& contents) {
  const ClientFiles& client = contents.client;
  const std::string_view path = path_of(request.target);
  const ClientFile* const file = client.find(path, request.accept_encoding);
  const bool is_folder = !client.empty() && path == kClientPath.substr(0, kClientPath.size() - 1);
  const Route* const route = find_route(request.target);
  const bool is_map_data = route == nullptr && path.starts_with(kMapDataPath);
  if (file == nullptr && !is_folder && !is_map_data && route == nullptr)
    return plain_answer(404, "there is no such page");
  if (!is_read(request)) return only_read_answer();
  if (file != nullptr) return file_answer(*file, request);
  if (is_folder) {
    HttpAnswer answer = plain_answer(308, "the client is one slash further");
    // Relative to the request, because the folder may be that of one of several worlds.
    answer.location = kClientPath.substr(1);
    return answer;
  }
  if (is_map_data) return plain_answer(404, "this gateway shows no map");
  return route->answer(contents);
}

HttpAnswer answer_gateway_request(const HttpRequest& request, const GatewayContents& contents) {
  const std::string_view path = path_of(request.target);
  std::string_view folder;  // that the request names without its last slash
  for (const WorldStatus& world : contents.worlds) {
    if (path.starts_with(kWorldsPath) && path.substr(kWorldsPath.size()) == world.name)
      folder = world.name;
  }
  const bool is_page =
      path == "/" || path == kStatusPath || path == kMetricsPath || path == kStylePath;
  if (!is_page && folder.empty()) {
    const bool is_of_world = path == kPlayPath || path.starts_with(kClientPath) || path == "/map";
    return plain_answer(404, is_of_world ? "this gateway has several worlds: choose one at /"
                                         : "there is no such page");
  }
  if (!is_read(request)) return only_read_answer();
  if (!folder.empty()) {
    HttpAnswer answer = plain_answer(308, "the world is one slash further");
    answer.location = std::string(folder) + "/";
    return answer;
  }
  if (path == kStylePath) return fixed("text/css; charset=utf-8", style_css());
  if (path == kMetricsPath) return metrics_answer(contents.worlds, contents.web);
  if (path == kStatusPath)
    return {200, kHtml, gateway_status_page(contents.config, contents.worlds, contents.web)};
  return {200, kHtml, worlds_page(contents.config, contents.worlds)};
}

HttpAnswer plain_answer(unsigned status, std::string sentence) {
  return {status, "text/plain; charset=utf-8", std::move(sentence) + "\n"};
}

std::vector<std::pair<std::string, std::string>> safety_headers(PageScripts scripts,
                                                                const std::string& sockets) {
  std::string more;
  if (scripts == PageScripts::own) more = "script-src 'self'; connect-src 'self'; ";
  // 'wasm-unsafe-eval' allows WebAssembly and no other code that is made at run time.
  if (scripts == PageScripts::client)
    more =
        "script-src 'self' 'wasm-unsafe-eval'; connect-src 'self'" + sockets + "; img-src data:; ";
  const bool has_forms = scripts == PageScripts::forms;
  if (has_forms) more = "img-src 'self'; ";
  return {
      {"Content-Security-Policy",
       "default-src 'none'; style-src 'self'; " + more + "base-uri 'none'; form-action " +
           (has_forms ? "'self'" : "'none'") + "; frame-ancestors 'none'"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Embedder-Policy", "require-corp"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"X-Content-Type-Options", "nosniff"},
      // With "no-referrer", browsers would send no origin with a form.
      {"Referrer-Policy", has_forms ? "same-origin" : "no-referrer"},
      {"X-Frame-Options", "DENY"},
  };
}

}  // namespace runstone
