// WebConfig: every setting of runstone-web with its default, unit and range. Variables of the
// environment begin with RUNSTONE_WEB_. docs/server-reference.md describes the settings.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/settings/settings_table.hpp"

namespace runstone {

/// One of several servers behind a gateway: a section [server.NAME] of the file.
struct WebServer {
  std::string name;            // in paths: 1..32 of a-z, 0-9 and '-'
  std::string gateway_socket;  // as in WebConfig, as are the next ones; never empty
  std::string title;           // empty: the name
  std::string public_address, world;
  friend bool operator==(const WebServer&, const WebServer&) = default;
};

struct WebConfig {
  // HOST:PORT, or [V6]:PORT; port 0 takes a free port.
  std::string listen = "127.0.0.1:8080";
  /// PEM files: a certificate chain and its secret key. Empty: plain HTTP, which is for an address
  /// of this machine only, unless `i_know` is set.
  std::string tls_certificate, tls_key;
  bool i_know = false;
  std::string gateway_socket = "world/web.sock";  // the server's setting of this name
  std::string title = "A Runstone world";         // of the world, on the pages
  std::string
      public_address;  // HOST or HOST:PORT of the server for desktop clients; empty: unknown
  /// Folder with the files of the client for browsers; empty: there is none on the pages.
  std::string client_files;
  /// Origins of pages that may open a WebSocket, such as "https://play.example.org", separated by
  /// blanks or commas. Empty: only pages of this gateway.
  std::string origins;
  /// The operators' page. Only under TLS or on an address of this machine.
  bool operators_page = false;
  std::string world;                   // place of the world, for its map; empty: no map
  std::uint64_t map_memory_mib = 128;  // of what was drawn, 8..65536
  /// Milliseconds a second in which the map draws for one address, 40 seconds' worth at once. 0: no
  /// limit.
  std::uint64_t map_ms_per_second = 250;
  std::uint64_t map_requests_per_second = 60;  // of one address, ten times at once, 0: no limit
  std::uint64_t sockets_max = 1'024;           // connections in any state, 1..65536
  std::uint64_t sockets_per_address = 64;      // 1..65536
  std::uint64_t connections_per_second = 20;   // of one address, ten times at once, 0: no limit
  std::uint64_t handshake_s = 10;  // seconds for TLS, for a request and for its answer, 1..3600
  std::uint64_t idle_s = 60;       // seconds without a sign of life from a browser, 2..86400
  /// Empty: there is one server, that of `gateway_socket`. Otherwise `gateway_socket`,
  /// `public_address` and `world` are not used, and `title` is that of the list of servers.
  std::vector<WebServer> servers;
  friend bool operator==(const WebConfig&, const WebConfig&) = default;
};

inline constexpr std::size_t kWebServersMax = 64;

/// Returns all settings, in the order of the struct, without the sections.
const SettingsTable<WebConfig>& web_settings();
/// Reads the settings and the sections of a TOML file, see SettingsTable::read_toml().
Result<void, TextError> read_web_toml(WebConfig& config, std::string_view toml,
                                      std::string_view file);
/// Fails if the sections and the other settings do not fit together: why. Flags and variables of
/// the environment may come after the file, so the caller checks after all of them.
Result<void, std::string> check_servers(const WebConfig& config);
/// Returns all settings and sections as TOML, which read_web_toml() reads back.
std::string to_web_toml(const WebConfig& config);
/// Returns the configuration for the pages and the map of one server of several: that of the
/// gateway with what the section says.
WebConfig config_for(const WebConfig& gateway, const WebServer& server);

}  // namespace runstone
