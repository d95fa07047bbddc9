// HttpAnswer: the answer to an HTTP request that opens no WebSocket. Paths come from fixed tables
// and nothing is looked up on disk, so no path can lead out of anything.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/web/client_files.hpp"
#include "server/web/server_status.hpp"
#include "server/web/web_config.hpp"
#include "server/web/web_counters.hpp"

namespace runstone {

/// The path at which browsers open a WebSocket.
inline constexpr std::string_view kPlayPath = "/play";
/// The path of the places of players, which are for those who may see the map alone.
inline constexpr std::string_view kMapPlayersPath = "/map/players.json";
/// The path of the border of the world. Players who may see only the map get it, too.
inline constexpr std::string_view kMapBorderPath = "/map/border.json";

/// How long browsers may keep an answer.
enum class HttpCaching {
  none,
  an_hour,
  while_unchanged,  // they ask each time whether their copy, named by its tag, is still right
};

/// The scripts that an answer may run.
enum class PageScripts {
  none,
  own,     // those of the gateway, which may connect to it: the map
  client,  // scripts of the gateway and WebAssembly: the client for browsers
  forms    // none, but forms and pictures of the gateway: the page for operators
};

struct HttpAnswer {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::string allow = {};  // the header Allow; empty: none
  HttpCaching caching = HttpCaching::none;
  PageScripts scripts = PageScripts::none;
  std::string location = {}, encoding = {}, tag = {}, cookie = {};  // headers; empty: none
  /// The body instead of `body`, shared by all answers that have it; may be null.
  std::shared_ptr<const std::string> shared = nullptr;

  std::string_view bytes() const { return shared ? std::string_view(*shared) : body; }
};

/// The headers of a request that matter.
struct HttpRequest {
  std::string_view method, target;
  std::string_view accept_encoding = {}, if_none_match = {};
};

/// Returns the path of a request target: what stands before the first '?'.
std::string_view path_of(std::string_view target);
/// Returns true if the page at this path shows the status of the server.
bool shows_status(std::string_view target);
/// The path of the page that shows the state of the server.
inline constexpr std::string_view kStatusPath = "/status";
/// The data that the pages show. `server` is read only for a path for which shows_status() returns
/// true.
struct PageContents {
  const WebConfig& config;
  const ClientFiles& client;
  const ServerStatus& server;
  const WebCounters& web;
  /// JSON of the newest edits for the page of the state; empty: they are not shown.
  std::string_view recent_edits = {};
  /// The name of the world if the gateway has several servers, otherwise empty.
  std::string_view world_name = {};
};
/// Returns the answer to a request.
HttpAnswer answer_request(const HttpRequest& request, const PageContents& contents);
/// The contents of the pages that belong to no single world: the list of the worlds, the status of
/// all of them, and the metrics. Only a gateway with several servers has them.
struct GatewayContents {
  const WebConfig& config;
  std::span<const WorldStatus> worlds;  // each has a status if shows_status()
  const WebCounters& web;
};
/// Returns the answer to a request that leads to no world.
HttpAnswer answer_gateway_request(const HttpRequest& request, const GatewayContents& contents);
/// Returns an answer that is one sentence.
HttpAnswer plain_answer(unsigned status, std::string sentence);

/// Returns the headers for the safety of browsers: pages load nothing from elsewhere, run no other
/// scripts, are shown in no frame, and share no process with other sites. `sockets`: where the
/// client may connect besides this gateway, see OriginCheck::sockets().
std::vector<std::pair<std::string, std::string>> safety_headers(PageScripts scripts,
                                                                const std::string& sockets);

}  // namespace runstone
