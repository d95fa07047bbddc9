#include "server/web/web_pages.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace runstone {
namespace {

constexpr std::size_t kPlayersShownMax = 200;

/// Returns a page with this title, of which `body` is HTML.
std::string page(const std::string& title, const std::string& body) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         html_text(title) +
         "</title>\n<link rel=\"stylesheet\" href=\"/style.css\">\n"
         "</head>\n<body>\n<h1>" +
         html_text(title) + "</h1>\n" + body + "</body>\n</html>\n";
}

std::string players_list(const ServerStatus& server) {
  if (server.players.empty()) return "<p>Nobody is in this world now.</p>\n";
  std::string out = "<ul>\n";
  const std::size_t shown = std::min(server.players.size(), kPlayersShownMax);
  for (std::size_t i = 0; i < shown; ++i) out += "<li>" + html_text(server.players[i]) + "</li>\n";
  if (shown < server.players.size())
    out += "<li>and " + std::to_string(server.players.size() - shown) + " more</li>\n";
  return out + "</ul>\n";
}

constexpr const char* kDownText =
    "<p class=\"down\">The server of this world is not running, or it is restarting. This page shows "
    "the world again when the server is back.</p>\n";

/// A table with a caption, of names and numbers.
std::string number_table(const char* caption,
                         const std::vector<std::pair<const char*, std::int64_t>>& rows) {
  std::string out = std::string("<table>\n<caption>") + caption + "</caption>\n";
  for (const auto& [name, value] : rows) {
    out += std::string("<tr><th scope=\"row\">") + name + "</th><td>" + std::to_string(value) +
           "</td></tr>\n";
  }
  return out + "</table>\n";
}

std::string server_tables(const ServerStatus& server) {
  const auto of = [&](const char* name) { return server.counter(name); };
  constexpr std::int64_t kMib = 1 << 20;
  return number_table("Players", {{"sessions now", of("sessions")},
                                  {"sessions since the start", of("opened")},
                                  {"connections since the start", of("connections")},
                                  {"connections refused", of("refused")},
                                  {"malformed messages", of("malformed")}}) +
         number_table("Edits", {{"edits in the log", of("seq")},
                                {"edits not on disk yet", of("seq") - of("durable")},
                                {"edits since the start", of("edits_ordered")},
                                {"edits refused since the start", of("edits_rejected")},
                                {"commits since the start", of("commits")}}) +
         number_table("Chunks", {{"chunks in memory", of("chunks_resident")},
                                 {"MiB of chunks in memory", of("resident_bytes") / kMib},
                                 {"chunks sent", of("snapshots_sent")},
                                 {"chunks that cannot be read", of("chunks_failed")},
                                 {"digests that differed", of("digest_mismatches")}}) +
         number_table("Traffic", {{"MiB received", of("bytes_in") / kMib},
                                  {"MiB sent", of("bytes_out") / kMib},
                                  {"messages beyond a full queue", of("queue_full")}});
}

std::string gateway_table(const WebCounters& web) {
  const auto number = [](std::uint64_t value) { return static_cast<std::int64_t>(value); };
  return number_table("This gateway", {{"connections now", number(web.connections_open)},
                                       {"WebSockets now", number(web.websockets_open)},
                                       {"WebSockets since the start", number(web.websockets)},
                                       {"WebSockets that broke a rule", number(web.rules_broken)},
                                       {"connections refused", number(web.refused)},
                                       {"pages sent", number(web.requests)},
                                       {"frames from browsers", number(web.frames_in)},
                                       {"frames to browsers", number(web.frames_out)}});
}

}  // namespace

std::string html_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string world_page(const WebConfig& config, bool has_client, const ServerStatus& server) {
  std::string body = server.is_up ? "<h2>Who is here</h2>\n" + players_list(server) : kDownText;
  body += "<h2>Join</h2>\n";
  if (has_client) body += "<p class=\"play\"><a href=\"/client/\">Play in this browser</a></p>\n";
  if (config.public_address.empty()) {
    if (!has_client) {
      body +=
          "<p>Ask the host of this world for its address, and join with the desktop client.</p>\n";
    }
  } else {
    const std::string link = html_text("runstone://" + config.public_address);
    body += "<p>Join with the desktop client: <a href=\"" + link + "\">" + link +
            "</a>. In a terminal:</p>\n<pre>runstone-client --connect '" + link + "'</pre>\n";
  }
  if (!has_client) body += "<p>This page has no client for the browser.</p>\n";
  body += "<p><a href=\"/status\">State of the server</a></p>\n";
  return page(config.title, body);
}

std::string status_page(const WebConfig& config, const ServerStatus& server,
                        const WebCounters& web) {
  std::string body = server.is_up ? "<p class=\"up\">The server is running.</p>\n" +
                                        players_list(server) + server_tables(server)
                                  : kDownText;
  body += gateway_table(web);
  body +=
      "<p><a href=\"/\">Back to the world</a>. The same numbers for Prometheus: "
      "<a href=\"/metrics\">/metrics</a></p>\n";
  return page(config.title + ": state", body);
}

std::string_view style_sheet() {
  return R"(body { margin: 2rem auto; max-width: 42rem; padding: 0 1rem; font: 1rem/1.5 sans-serif;
  color: #222; background: #fafaf8; overflow-wrap: anywhere; }
h1 { font-size: 1.6rem; }
h2, caption { font-size: 1.1rem; font-weight: bold; text-align: left; }
table { border-collapse: collapse; margin: 1rem 0; width: 100%; }
th, td { border-bottom: 1px solid #ccc; padding: 0.2rem 0; text-align: left; }
th { font-weight: normal; }
td { text-align: right; font-variant-numeric: tabular-nums; }
pre { background: #eee; padding: 0.5rem; overflow-x: auto; }
a { color: #14568c; }
.play a { font-size: 1.3rem; font-weight: bold; }
.up { color: #1c6b2a; }
.down { color: #9c2a10; }
@media (prefers-color-scheme: dark) {
  body { color: #ddd; background: #1b1c1e; }
  pre { background: #2a2c2f; }
  a { color: #8fc1ee; }
  .up { color: #7fce8c; }
  .down { color: #f09a84; }
}
)";
}

}  // namespace runstone
