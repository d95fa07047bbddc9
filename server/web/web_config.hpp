// WebConfig: every setting of runstone-web with its default, unit and range. The naming rule is that
// of the server's settings:
//   file         sockets_max = 64
//   environment  RUNSTONE_WEB_SOCKETS_MAX=64
//   flag         --sockets-max 64
// The order of precedence is flag, environment, file, default. Values are checked when they are
// set. docs/server-reference.md describes the settings.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

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
  /// Origins of pages that may open a WebSocket, such as "https://play.example.org", separated by
  /// blanks or commas. Empty: only pages of this gateway.
  std::string origins;
  std::uint64_t sockets_max = 1'024;          // connections in any state, 1..65536
  std::uint64_t sockets_per_address = 64;     // 1..65536
  std::uint64_t connections_per_second = 20;  // of one address, ten times at once, 0: no limit
  std::uint64_t handshake_s = 10;  // seconds for TLS, for a request and for its answer, 1..3600
  std::uint64_t idle_s = 60;       // seconds without a sign of life from a browser, 2..86400
  friend bool operator==(const WebConfig&, const WebConfig&) = default;
};

struct WebConfigField {
  std::string name;        // as in the file
  std::string help;        // unit and range
  bool is_switch = false;  // true or false; its flag needs no value
};
/// Returns all settings, in the order of the struct.
std::vector<WebConfigField> web_config_fields();
/// Return "RUNSTONE_WEB_SOCKETS_MAX" and "--sockets-max" for "sockets_max".
std::string web_environment_name(const std::string& field);
std::string web_flag_name(const std::string& field);

/// Sets one field from the text of a flag or variable. The error names the field and says what is
/// wrong.
Result<void, std::string> set_web_config(WebConfig& config, const std::string& field,
                                         const std::string& text);
/// Sets the fields that a TOML file names; `file` is only for messages. Fails on unknown keys and
/// wrong values, with their line; `config` is then unchanged.
Result<void, std::string> read_web_config_toml(WebConfig& config, std::string_view toml,
                                               std::string_view file);
/// Sets the fields that the environment names. `look_up` returns the value of a variable, or
/// nullopt.
Result<void, std::string> read_web_config_environment(
    WebConfig& config,
    const std::function<std::optional<std::string>(const std::string&)>& look_up);
/// Returns all fields as TOML, which read_web_config_toml() reads back to an equal configuration.
std::string to_toml(const WebConfig& config);

}  // namespace runstone
