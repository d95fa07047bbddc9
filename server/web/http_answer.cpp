#include "server/web/http_answer.hpp"

#include <array>

#include "server/web/metrics_text.hpp"
#include "server/web/web_pages.hpp"

namespace runstone {
namespace {

struct Route {
  std::string_view path;
  bool shows_status;
  HttpAnswer (*answer)(const WebConfig&, bool has_client, const ServerStatus&, const WebCounters&);
};

constexpr const char* kHtml = "text/html; charset=utf-8";

constexpr std::array<Route, 5> kRoutes = {{
    {"/", true,
     [](const WebConfig& config, bool has_client, const ServerStatus& server,
        const WebCounters& /*web*/) {
       return HttpAnswer{200, kHtml, world_page(config, has_client, server)};
     }},
    {"/status", true,
     [](const WebConfig& config, bool /*has_client*/, const ServerStatus& server,
        const WebCounters& web) {
       return HttpAnswer{200, kHtml, status_page(config, server, web)};
     }},
    {"/metrics", true,
     [](const WebConfig& /*config*/, bool /*has_client*/, const ServerStatus& server,
        const WebCounters& web) {
       return HttpAnswer{200, "text/plain; version=0.0.4; charset=utf-8",
                         metrics_text(server, web)};
     }},
    {"/style.css", false,
     [](const WebConfig& /*config*/, bool /*has_client*/, const ServerStatus& /*server*/,
        const WebCounters& /*web*/) {
       return HttpAnswer{200, "text/css; charset=utf-8", std::string(style_sheet()), "",
                         HttpCaching::an_hour};
     }},
    {kPlayPath, false,
     [](const WebConfig& /*config*/, bool /*has_client*/, const ServerStatus& /*server*/,
        const WebCounters& /*web*/) {
       return plain_answer(426, "this address is for WebSockets");
     }},
}};

const Route* find_route(std::string_view target) {
  for (const Route& route : kRoutes) {
    if (route.path == path_of(target)) return &route;
  }
  return nullptr;
}

HttpAnswer file_answer(const ClientFile& file, const HttpRequest& request) {
  HttpAnswer answer;
  answer.type = file.type;
  answer.caching = HttpCaching::while_unchanged;
  answer.runs_client = true;
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

HttpAnswer answer_request(const HttpRequest& request, const WebConfig& config,
                          const ClientFiles& client, const ServerStatus& server,
                          const WebCounters& web) {
  const std::string_view path = path_of(request.target);
  const ClientFile* const file = client.find(path, request.accept_encoding);
  const bool is_folder = !client.empty() && path == kClientPath.substr(0, kClientPath.size() - 1);
  const Route* const route = find_route(request.target);
  if (file == nullptr && !is_folder && route == nullptr)
    return plain_answer(404, "there is no such page");
  if (request.method != "GET" && request.method != "HEAD") {
    HttpAnswer answer = plain_answer(405, "this page can only be read");
    answer.allow = "GET, HEAD";
    return answer;
  }
  if (file != nullptr) return file_answer(*file, request);
  if (is_folder) {
    HttpAnswer answer = plain_answer(308, "the client is one slash further");
    answer.location = kClientPath;
    return answer;
  }
  return route->answer(config, !client.empty(), server, web);
}

HttpAnswer plain_answer(unsigned status, std::string sentence) {
  return {status, "text/plain; charset=utf-8", std::move(sentence) + "\n"};
}

const std::vector<std::pair<std::string, std::string>>& safety_headers(bool runs_client) {
  using Headers = std::vector<std::pair<std::string, std::string>>;
  const auto with_policy = [](const char* policy) -> Headers {
    return {
        {"Content-Security-Policy", policy},
        {"Cross-Origin-Opener-Policy", "same-origin"},
        {"Cross-Origin-Embedder-Policy", "require-corp"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
        {"X-Content-Type-Options", "nosniff"},
        {"Referrer-Policy", "no-referrer"},
    };
  };
  static const Headers pages = with_policy(
      "default-src 'none'; style-src 'self'; base-uri 'none'; form-action 'none'; "
      "frame-ancestors 'none'");
  // 'wasm-unsafe-eval' allows WebAssembly and no other code that is made at run time.
  static const Headers client = with_policy(
      "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; "
      "connect-src 'self'; img-src data:; base-uri 'none'; form-action 'none'; "
      "frame-ancestors 'none'");
  return runs_client ? client : pages;
}

}  // namespace runstone
