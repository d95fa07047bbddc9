#include "server/web/web_pages.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "common/os/host_port.hpp"
#include "protocol/default_port.hpp"
#include "server/web/page_files.hpp"

namespace runstone {
namespace {

constexpr std::size_t kPlayersShownMax = 200;

std::string players_list(const ServerStatus& server) {
  if (server.players.empty()) return "<p>Nobody is in this world now.</p>\n";
  std::string out = "<ul>\n";
  const std::size_t shown = std::min(server.players.size(), kPlayersShownMax);
  for (std::size_t i = 0; i < shown; ++i) out += "<li>" + html_text(server.players[i]) + "</li>\n";
  if (shown < server.players.size())
    out += "<li>and " + std::to_string(server.players.size() - shown) + " more</li>\n";
  return out + "</ul>\n";
}

constexpr const char* kMetricsText =
    "The same numbers for Prometheus: <a href=\"metrics\">/metrics</a></p>\n";

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

/// A table of how long edits waited, with a bar for each row: numbers work without JavaScript.
std::string waits_table(const ServerStatus& server) {
  const std::int64_t all = server.counter("edit_wait_count");
  std::string out = "<table>\n<caption>From an edit to its commit, on the server</caption>\n";
  std::uint64_t before = 0;
  const auto row = [&](const std::string& name, std::uint64_t count) {
    const std::uint64_t share = all > 0 ? 100 * count / static_cast<std::uint64_t>(all) : 0;
    out += "<tr><th scope=\"row\">" + name + "</th><td><meter min=\"0\" max=\"100\" value=\"" +
           std::to_string(share) + "\">" + std::to_string(share) + " %</meter></td><td>" +
           std::to_string(count) + "</td></tr>\n";
  };
  for (const EditWaits& waits : edit_waits(server, "edit_wait")) {
    row("up to " + std::to_string(waits.ms_max) + " ms",
        waits.count - std::min(before, waits.count));
    before = std::max(before, waits.count);
  }
  const auto total = static_cast<std::uint64_t>(std::max<std::int64_t>(all, 0));
  row("longer", total - std::min(before, total));
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
         waits_table(server) +
         number_table("Chunks", {{"chunks in memory", of("chunks_resident")},
                                 {"MiB of chunks in memory", of("resident_bytes") / kMib},
                                 {"chunks sent", of("snapshots_sent")},
                                 {"chunks that cannot be read", of("chunks_failed")},
                                 {"digests that differed", of("digest_mismatches")}}) +
         number_table("Disk", {{"MiB free", of("disk_free_bytes") / kMib},
                               {"MiB of the world", of("world_bytes") / kMib},
                               {"MiB of its write-ahead log", of("wal_bytes") / kMib},
                               {"ms that the disk is behind", of("durable_lag_us") / 1'000},
                               {"damaged rows", of("row_faults")}}) +
         number_table("Memory", {{"MiB of the server", of("memory_bytes") / kMib},
                                 {"MiB of edits on chunks", of("stacked_bytes") / kMib},
                                 {"MiB of messages to send", of("queued_bytes") / kMib}}) +
         number_table("Traffic", {{"MiB received", of("bytes_in") / kMib},
                                  {"MiB sent", of("bytes_out") / kMib},
                                  {"of them MiB of terrain", of("chunk_bytes_out") / kMib},
                                  {"of them MiB of edits", of("edit_bytes_out") / kMib},
                                  {"messages beyond a full queue", of("queue_full")}});
}

/// A table of the newest edits, or nothing.
std::string edits_table(std::string_view recent_edits) {
  const auto list = nlohmann::json::parse(recent_edits, nullptr, false);
  if (!list.is_array() || list.empty()) return "";
  std::string out = "<table>\n<caption>Newest edits</caption>\n";
  for (const auto& edit : list) {
    const auto text = [&](const char* name) {
      const auto found = edit.find(name);
      return found != edit.end() && found->is_string() ? html_text(found->get<std::string>()) : "";
    };
    out += "<tr><th scope=\"row\">" + text("time") + " <b>" + text("author") + "</b></th><td>" +
           text("what") + "</td></tr>\n";
  }
  return out + "</table>\n";
}

std::string gateway_table(const WebCounters& web) {
  const auto number = [](std::uint64_t value) { return static_cast<std::int64_t>(value); };
  return number_table("This gateway", {{"connections now", number(web.connections_open)},
                                       {"WebSockets now", number(web.websockets_open)},
                                       {"WebSockets since the start", number(web.websockets)},
                                       {"WebSockets that broke a rule", number(web.rules_broken)},
                                       {"WebSockets without a server", number(web.links_failed)},
                                       {"connections refused", number(web.refused)},
                                       {"connections closed to make room", number(web.evicted)},
                                       {"connections without a socket", number(web.accepts_failed)},
                                       {"pages sent", number(web.requests)},
                                       {"frames from browsers", number(web.frames_in)},
                                       {"frames to browsers", number(web.frames_out)},
                                       {"requests for the map", number(web.map_requests)},
                                       {"of them unchanged", number(web.map_not_modified)},
                                       {"refused because of a limit", number(web.map_refused)},
                                       {"seconds of drawing", number(web.map_work_us / 1'000'000)},
                                       {"MiB of drawn tiles", number(web.map_cache_bytes >> 20)},
                                       {"MiB of the gateway", number(web.memory_bytes >> 20)}});
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

std::string html_page(const std::string& title, const std::string& body) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         html_text(title) +
         "</title>\n<link rel=\"stylesheet\" href=\"style.css\">\n"
         "</head>\n<body>\n<h1>" +
         html_text(title) + "</h1>\n" + body + "</body>\n</html>\n";
}

std::string world_page(const WebConfig& config, bool has_client, const ServerStatus& server) {
  std::string body = server.is_up ? "<h2>Who is here</h2>\n" + players_list(server) : kDownText;
  body += "<h2>Join</h2>\n";
  if (has_client) body += "<p class=\"play\"><a href=\"client/\">Play in this browser</a></p>\n";
  if (config.public_address.empty()) {
    if (!has_client) {
      body +=
          "<p>Ask the host of this world for its address, and join with the desktop client.</p>\n";
    }
  } else {
    const auto address = parse_host_port(config.public_address, kDefaultPort);
    const std::string link =
        html_text("runstone://" + (address ? to_string(*address) : config.public_address));
    body += "<p>Join with the desktop client: <a href=\"" + link + "\">" + link +
            "</a>. In a terminal:</p>\n<pre>runstone-client --connect '" + link + "'</pre>\n";
  }
  if (!has_client) body += "<p>This page has no client for the browser.</p>\n";
  body += "<p>";
  if (!config.world.empty()) body += "<a href=\"map\">Map of the world</a>. ";
  body += "<a href=\"status\">State of the server</a></p>\n";
  return html_page(config.title, body);
}

std::string status_page(const WebConfig& config, const ServerStatus& server, const WebCounters& web,
                        std::string_view recent_edits, bool is_one_of_several) {
  std::string body = kDownText;
  if (server.is_up) {
    body = "<p class=\"up\">The server is running.</p>\n";
    if (!server.read_only.empty())
      body += "<p class=\"down\">Edits are refused: " + html_text(server.read_only) + ".</p>\n";
    body += players_list(server) + server_tables(server);
  }
  body += edits_table(recent_edits);
  if (is_one_of_several) {
    body +=
        "<p><a href=\"./\">Back to the world</a>. <a href=\"../../status\">State of all worlds and "
        "of the gateway</a></p>\n";
  } else {
    body += gateway_table(web) + "<p><a href=\"./\">Back to the world</a>. " + kMetricsText;
  }
  return html_page(config.title + ": state", body);
}

std::string worlds_page(const WebConfig& config, std::span<const WorldStatus> worlds) {
  std::string body = "<h2>Worlds</h2>\n<ul>\n";
  for (const WorldStatus& world : worlds) {
    const std::size_t players = world.status->players.size();
    body += "<li><a href=\"world/" + html_text(world.name) + "/\">" + html_text(world.title) +
            "</a>: " +
            (!world.status->is_up ? "not running now"
             : players == 0       ? "nobody is there"
             : players == 1       ? "1 player"
                                  : std::to_string(players) + " players") +
            "</li>\n";
  }
  body += "</ul>\n<p><a href=\"status\">State of the servers</a></p>\n";
  return html_page(config.title, body);
}

std::string gateway_status_page(const WebConfig& config, std::span<const WorldStatus> worlds,
                                const WebCounters& web) {
  std::string body = "<table>\n<caption>Worlds</caption>\n";
  for (const WorldStatus& world : worlds) {
    body += "<tr><th scope=\"row\"><a href=\"world/" + html_text(world.name) + "/status\">" +
            html_text(world.title) + "</a></th><td>" +
            (world.status->is_up
                 ? "running, sessions: " + std::to_string(world.status->counter("sessions"))
                 : "not running") +
            "</td></tr>\n";
  }
  body += "</table>\n" + gateway_table(web) + "<p><a href=\"./\">Back to the worlds</a>. " +
          kMetricsText;
  return html_page(config.title + ": state", body);
}

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

std::string map_border_json(const ServerStatus& server) {
  nlohmann::json out = nlohmann::json::object();
  if (server.border) {
    const auto& [a, b, c, d] = server.border->numbers;
    if (server.border->is_circle) {
      out["circle"] = {a, b, c};
    } else {
      out["box"] = {a, b, c, d};
    }
  }
  return out.dump();
}

}  // namespace runstone
