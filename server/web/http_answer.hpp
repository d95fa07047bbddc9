// HttpAnswer: the answer to an HTTP request that opens no WebSocket. Paths come from a fixed table
// and nothing is looked up on disk, so no path can lead out of anything.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/web/server_status.hpp"
#include "server/web/web_config.hpp"
#include "server/web/web_counters.hpp"

namespace runstone {

/// The path at which browsers open a WebSocket.
inline constexpr std::string_view kPlayPath = "/play";
/// The path of the places of players, which are for those who may see the map alone.
inline constexpr std::string_view kMapPlayersPath = "/map/players.json";

struct HttpAnswer {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::string allow;                                    // the header Allow; empty: none
  bool is_fixed = false;                                // browsers may keep it for an hour
  std::string etag = {};                                // the header ETag; empty: none
  std::shared_ptr<const std::string> shared = nullptr;  // the body instead of `body`, if not null

  const std::string& text() const { return shared == nullptr ? body : *shared; }
};

/// Returns the path of a request target: what stands before the first '?'.
std::string_view path_of(std::string_view target);
/// Returns true if the page at this path shows the status of the server.
bool shows_status(std::string_view target);
/// The path of the page that shows the state of the server.
inline constexpr std::string_view kStatusPath = "/status";
/// Returns the answer to a request. `server` is used only if shows_status(). `recent_edits`: JSON of
/// the newest edits for the page of the state; empty: they are not shown.
HttpAnswer answer_request(std::string_view method, std::string_view target, const WebConfig& config,
                          const ServerStatus& server, const WebCounters& web,
                          std::string_view recent_edits = {});
/// Returns an answer that is one sentence.
HttpAnswer plain_answer(unsigned status, std::string sentence);

/// Returns the headers that each response has for the safety of browsers: pages load nothing from
/// elsewhere, run no script within tags, are shown in no frame, and share no process with other
/// sites.
const std::vector<std::pair<std::string, std::string>>& safety_headers();

}  // namespace runstone
