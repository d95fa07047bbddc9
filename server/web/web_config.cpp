#include "server/web/web_config.hpp"

#include <optional>

#include "common/core/text.hpp"

namespace runstone {
namespace {

constexpr std::size_t kWebTextBytesMax = 1'024;

}  // namespace

const SettingsTable<WebConfig>& web_settings() {
  using C = WebConfig;
  const auto number = number_setting<C>;
  const auto text = [](const char* name, const char* help, std::string C::* member,
                       bool is_optional) {
    Setting<C> out = text_setting(name, help, member, is_optional);
    // The texts stand on pages and in log lines.
    out.set = [set = out.set](C& config, const std::string& value) -> std::optional<std::string> {
      if (value.size() > kWebTextBytesMax || !is_printable_utf8(value))
        return "must be one line of UTF-8 text of at most " + std::to_string(kWebTextBytesMax) +
               " bytes";
      return set(config, value);
    };
    return out;
  };
  static const SettingsTable<C> all(
      "RUNSTONE_WEB_",
      {
          text("listen", "HOST, HOST:PORT, [V6]:PORT or :PORT; port 0 takes a free one", &C::listen,
               false),
          text("tls_certificate",
               "PEM file: certificate chain; empty: plain HTTP, for this machine only",
               &C::tls_certificate, true),
          text("tls_key", "PEM file: secret key of tls_certificate", &C::tls_key, true),
          flag_setting("i_know", "allow plain HTTP on every address", &C::i_know),
          text("gateway_socket", "path of the server's setting gateway_socket", &C::gateway_socket,
               false),
          text("title", "name of the world on the pages", &C::title, false),
          text("public_address",
               "HOST or HOST:PORT at which desktop clients reach the server, for the page",
               &C::public_address, true),
          text("client_files",
               "folder with the files of the client for browsers; empty: the pages have none",
               &C::client_files, true),
          text("origins",
               "origins of pages that may open a WebSocket, such as https://play.example.org, "
               "separated by blanks or commas; empty: only pages of this gateway",
               &C::origins, true),
          text("world", "folder of the world, to show its map at /map; empty: no map", &C::world,
               true),
          number("map_memory_mib", &C::map_memory_mib, 8, 65'536,
                 "MiB of memory for what the map has drawn"),
          number(
              "map_ms_per_second", &C::map_ms_per_second, 0, 1'000,
              "milliseconds a second in which the map draws for one address, forty times as many "
              "at once, 0: no limit"),
          number("map_requests_per_second", &C::map_requests_per_second, 0, 1'000'000,
                 "requests a second of one address for the map, ten times as many at once, 0: no "
                 "limit"),
          number("sockets_max", &C::sockets_max, 1, 65'536, "connections in any state"),
          number("sockets_per_address", &C::sockets_per_address, 1, 65'536,
                 "connections of one address"),
          number("connections_per_second", &C::connections_per_second, 0, 1'000'000,
                 "connections a second from one address, ten times as many at once, 0: no limit"),
          number("handshake_s", &C::handshake_s, 1, 3'600,
                 "seconds for TLS, for a request and for its answer"),
          number("idle_s", &C::idle_s, 2, 86'400,
                 "seconds without a sign of life until a WebSocket ends"),
      });
  return all;
}

}  // namespace runstone
