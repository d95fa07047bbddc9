#include "server/web/web_config.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>
#include <variant>

#include "common/core/text.hpp"

namespace runstone {
namespace {

constexpr std::size_t kWebTextBytesMax = 1'024;

struct WebNumber {
  std::uint64_t WebConfig::* member;
  std::uint64_t min, max;
};
struct WebText {
  std::string WebConfig::* member;
  bool is_optional;
};
struct WebSwitch {
  bool WebConfig::* member;
};
struct WebField {
  std::string name, help;
  std::variant<WebNumber, WebText, WebSwitch> kind;
};

const std::vector<WebField>& web_fields() {
  using C = WebConfig;
  const auto number = [](const char* name, std::uint64_t C::* member, std::uint64_t min,
                         std::uint64_t max, const std::string& what) {
    return WebField{name, what + ", " + std::to_string(min) + ".." + std::to_string(max),
                    WebNumber{member, min, max}};
  };
  const auto optional = [](const char* name, std::string C::* member, const char* what) {
    return WebField{name, what, WebText{member, true}};
  };
  static const std::vector<WebField> all = {
      {"listen", "HOST, HOST:PORT, [V6]:PORT or :PORT; port 0 takes a free one",
       WebText{&C::listen, false}},
      optional("tls_certificate", &C::tls_certificate,
               "PEM file: certificate chain; empty: plain HTTP, for this machine only"),
      optional("tls_key", &C::tls_key, "PEM file: secret key of tls_certificate"),
      {"i_know", "allow plain HTTP on every address", WebSwitch{&C::i_know}},
      {"gateway_socket", "path of the server's setting gateway_socket",
       WebText{&C::gateway_socket, false}},
      {"title", "name of the world on the pages", WebText{&C::title, false}},
      optional("public_address", &C::public_address,
               "HOST or HOST:PORT at which desktop clients reach the server, for the page"),
      optional("origins", &C::origins,
               "origins of pages that may open a WebSocket, such as https://play.example.org, "
               "separated by blanks or commas; empty: only pages of this gateway"),
      number("sockets_max", &C::sockets_max, 1, 65'536, "connections in any state"),
      number("sockets_per_address", &C::sockets_per_address, 1, 65'536,
             "connections of one address"),
      number("connections_per_second", &C::connections_per_second, 0, 1'000'000,
             "connections a second from one address, ten times as many at once, 0: no limit"),
      number("handshake_s", &C::handshake_s, 1, 3'600,
             "seconds for TLS, for a request and for its answer"),
      number("idle_s", &C::idle_s, 2, 86'400,
             "seconds without a sign of life until a WebSocket ends"),
  };
  return all;
}

const WebField* find_web_field(std::string_view name) {
  const auto& all = web_fields();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const WebField& field) { return field.name == name; });
  return found == all.end() ? nullptr : &*found;
}

/// Sets a field. Returns what is wrong with the text, or nullopt.
std::optional<std::string> set_field(WebConfig& config, const WebField& field,
                                     const std::string& text) {
  if (const auto* number = std::get_if<WebNumber>(&field.kind)) {
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || rest != end) return "must be a whole number: " + field.help;
    if (value < number->min || value > number->max) return "is out of range: " + field.help;
    config.*number->member = value;
    return std::nullopt;
  }
  if (const auto* flag = std::get_if<WebSwitch>(&field.kind)) {
    if (text != "true" && text != "false") return "must be true or false: " + field.help;
    config.*flag->member = text == "true";
    return std::nullopt;
  }
  const auto& kind = std::get<WebText>(field.kind);
  if (text.empty() && !kind.is_optional) return "must not be empty";
  if (text.size() > kWebTextBytesMax || !is_printable_utf8(text))
    return "must be one line of UTF-8 text of at most " + std::to_string(kWebTextBytesMax) +
           " bytes";
  config.*kind.member = text;
  return std::nullopt;
}

std::string field_text(const WebConfig& config, const WebField& field) {
  if (const auto* number = std::get_if<WebNumber>(&field.kind))
    return std::to_string(config.*number->member);
  if (const auto* flag = std::get_if<WebSwitch>(&field.kind))
    return config.*flag->member ? "true" : "false";
  return config.*std::get<WebText>(field.kind).member;
}

/// Returns the text of a value of TOML, or nullopt if no setting has this type.
std::optional<std::string> value_text(const toml::node& node, const WebField& field) {
  if (std::holds_alternative<WebText>(field.kind)) return node.value_exact<std::string>();
  if (std::holds_alternative<WebSwitch>(field.kind)) {
    const auto flag = node.value_exact<bool>();
    return flag ? std::optional<std::string>(*flag ? "true" : "false") : std::nullopt;
  }
  const auto number = node.value_exact<std::int64_t>();
  return number ? std::optional(std::to_string(*number)) : std::nullopt;
}

}  // namespace

std::vector<WebConfigField> web_config_fields() {
  std::vector<WebConfigField> all;
  for (const WebField& field : web_fields())
    all.push_back({field.name, field.help, std::holds_alternative<WebSwitch>(field.kind)});
  return all;
}

std::string web_environment_name(const std::string& field) {
  std::string name = "RUNSTONE_WEB_";
  for (const char c : field) name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

std::string web_flag_name(const std::string& field) {
  std::string name = "--" + field;
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

Result<void, std::string> set_web_config(WebConfig& config, const std::string& name,
                                         const std::string& text) {
  const WebField* field = find_web_field(name);
  if (field == nullptr) return failure(name + ": no such setting");
  const auto wrong = set_field(config, *field, text);
  if (wrong) return failure(name + " = \"" + text + "\": " + *wrong);
  return {};
}

Result<void, std::string> read_web_config_toml(WebConfig& config, std::string_view toml,
                                               std::string_view file) {
  const auto wrong = [&](std::uint32_t line, std::string_view key, std::string_view what) {
    return failure(std::string(file) + ":" + std::to_string(line) + ": " + std::string(key) +
                   (key.empty() ? "" : ": ") + std::string(what));
  };
  toml::table table;
  try {
    table = toml::parse(toml, file);
  } catch (const toml::parse_error& error) {
    return wrong(error.source().begin.line, "", error.description());
  }
  WebConfig read = config;  // an error leaves `config` unchanged
  for (const auto& [key, node] : table) {
    const std::uint32_t line = key.source().begin.line;
    const WebField* field = find_web_field(key.str());
    if (field == nullptr) return wrong(line, key.str(), "no such setting");
    const auto text = value_text(node, *field);
    if (!text) return wrong(line, key.str(), "has the wrong type: " + field->help);
    if (const auto what = set_field(read, *field, *text)) return wrong(line, key.str(), *what);
  }
  config = std::move(read);
  return {};
}

Result<void, std::string> read_web_config_environment(
    WebConfig& config,
    const std::function<std::optional<std::string>(const std::string&)>& look_up) {
  for (const WebField& field : web_fields()) {
    const auto text = look_up(web_environment_name(field.name));
    if (!text) continue;
    const auto set = set_web_config(config, field.name, *text);
    if (!set) return failure(web_environment_name(field.name) + ": " + set.error());
  }
  return {};
}

std::string to_toml(const WebConfig& config) {
  std::string out;
  for (const WebField& field : web_fields()) {
    out += field.name + " = ";
    const std::string text = field_text(config, field);
    if (std::holds_alternative<WebText>(field.kind)) {
      std::ostringstream quoted;
      quoted << toml::value<std::string>(text);
      out += quoted.str();
    } else {
      out += text;
    }
    out += "  # " + field.help + "\n";
  }
  return out;
}

}  // namespace runstone
