#include "server/web/web_config.hpp"

#include <optional>

#include "common/core/text.hpp"
#include "server/settings/address_check.hpp"
#include "server/store/place_rule.hpp"

namespace runstone {
namespace {

constexpr std::size_t kWebTextBytesMax = 1'024;
constexpr const char* kSectionKind = "server";
constexpr std::size_t kServerNameBytesMax = 32;

/// Makes a setting that is one line of text.
template <class Config>
Setting<Config> line_setting(const char* name, const char* help, std::string Config::* member,
                             bool is_optional) {
  Setting<Config> out = text_setting(name, help, member, is_optional);
  // The texts stand on pages and in log lines.
  out.set = [set = out.set](Config& config, const std::string& value) -> Result<void, std::string> {
    if (value.size() > kWebTextBytesMax || !is_printable_utf8(value))
      return failure("must be one line of UTF-8 text of at most " +
                     std::to_string(kWebTextBytesMax) + " bytes");
    return set(config, value);
  };
  return out;
}

/// Makes a setting that is empty or has a form of its own.
template <class Config>
Setting<Config> with_check(Setting<Config> setting,
                           Result<void, std::string> (*check)(const std::string& text)) {
  setting.set = [set = setting.set, check](Config& config,
                                           const std::string& value) -> Result<void, std::string> {
    if (!value.empty()) {
      if (auto fits = check(value); !fits) return fits;
    }
    return set(config, value);
  };
  return setting;
}

template <class Config>
Setting<Config> public_address_setting(const char* help, std::string Config::* member) {
  return with_check(line_setting("public_address", help, member, true), check_public_address);
}

template <class Config>
Setting<Config> world_setting(const char* help, std::string Config::* member) {
  Setting<Config> out = with_check(line_setting("world", help, member, true), check_place);
  out.has_secret = true;  // the password of a database
  return out;
}

const SettingsTable<WebServer>& server_settings() {
  using S = WebServer;
  static const SettingsTable<S> all(
      "",
      {
          line_setting<S>("gateway_socket", "path of the server's setting gateway_socket",
                          &S::gateway_socket, false),
          line_setting<S>("title", "name of the world on the pages", &S::title, true),
          public_address_setting<S>("HOST or HOST:PORT at which desktop clients reach the server",
                                    &S::public_address),
          world_setting<S>("folder or database of the world, to show its map; empty: no map",
                           &S::world),
      });
  return all;
}

bool is_server_name(std::string_view name) {
  return !name.empty() && name.size() <= kServerNameBytesMax &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string_view::npos;
}

}  // namespace

Result<void, std::string> check_servers(const WebConfig& config) {
  if (config.servers.empty()) return {};
  if (config.servers.size() > kWebServersMax)
    return failure("at most " + std::to_string(kWebServersMax) + " servers fit behind one gateway");
  const WebConfig defaults;
  if (config.gateway_socket != defaults.gateway_socket || !config.world.empty() ||
      !config.public_address.empty())
    return failure(
        "gateway_socket, world and public_address belong into the sections of the servers");
  return {};
}

Result<void, TextError> read_web_toml(WebConfig& config, std::string_view toml,
                                      std::string_view file) {
  WebConfig read = config;
  if (auto done = web_settings().read_toml(read, toml, file, kSectionKind); !done) return done;
  const auto sections = read_toml_sections(toml, file, kSectionKind);
  if (!sections) return failure(sections.error());
  for (const TomlSection& section : *sections) {
    const auto wrong = [&](const std::string& why) {
      return failure(TextError{std::string(file), section.line,
                               std::string(kSectionKind) + "." + section.name, why});
    };
    if (!is_server_name(section.name))
      return wrong("the name of a server has 1 to 32 characters of a-z, 0-9 and '-'");
    WebServer server{section.name, "", "", "", ""};
    if (auto done = server_settings().read_values(server, section.settings, file); !done)
      return done;
    if (server.gateway_socket.empty()) return wrong("gateway_socket is missing");
    for (const WebServer& other : read.servers) {
      if (other.gateway_socket == server.gateway_socket)
        return wrong("its gateway_socket is that of the server " + other.name);
    }
    read.servers.push_back(std::move(server));
    if (const auto checked = check_servers(read); !checked) return wrong(checked.error());
  }
  config = std::move(read);
  return {};
}

std::string to_web_toml(const WebConfig& config) {
  std::string out = web_settings().to_toml(config);
  for (const WebServer& server : config.servers) {
    out += std::string("\n[") + kSectionKind + "." + server.name + "]\n" +
           server_settings().to_toml(server);
  }
  return out;
}

WebConfig config_for(const WebConfig& gateway, const WebServer& server) {
  WebConfig out = gateway;
  out.servers.clear();
  out.gateway_socket = server.gateway_socket;
  out.title = server.title.empty() ? server.name : server.title;
  out.public_address = server.public_address;
  out.world = server.world;
  return out;
}

const SettingsTable<WebConfig>& web_settings() {
  using C = WebConfig;
  const auto number = number_setting<C>;
  const auto text = line_setting<C>;
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
          public_address_setting<C>(
              "HOST or HOST:PORT at which desktop clients reach the server, for the page",
              &C::public_address),
          text("client_files",
               "folder with the files of the client for browsers; empty: the pages have none",
               &C::client_files, true),
          text("origins",
               "origins of pages that may open a WebSocket, such as https://play.example.org, "
               "separated by blanks or commas; empty: only pages of this gateway",
               &C::origins, true),
          flag_setting("operators_page",
                       "the page for operators at /operators/; only with a certificate or on an "
                       "address of this machine",
                       &C::operators_page),
          world_setting<C>(
              "folder or database of the world, to show its map at /map; empty: no map", &C::world),
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
