#include "common/os/host_port.hpp"

#include <charconv>
#include <optional>
#include <utility>

namespace runstone {
namespace {

using Parsed = Result<HostPort, std::string>;

Parsed wrong_form() { return failure("expected HOST, HOST:PORT or [V6]:PORT"); }

/// Returns true if the text, up to a zone such as "%eth0", has only characters of an IPv6 address.
bool may_be_v6(std::string_view text) {
  const std::string_view address = text.substr(0, text.find('%'));
  return !address.empty() &&
         address.find_first_not_of("0123456789abcdefABCDEF:.") == std::string_view::npos;
}

struct Ports {
  std::uint16_t if_absent;
  std::uint16_t lowest;
};

/// Requires a nonempty `host`. `port` is the text after the colon, or nullopt without a colon.
Parsed with_port(std::string_view host, std::optional<std::string_view> port, Ports ports) {
  HostPort out{std::string(host), ports.if_absent};
  if (!port) return out;
  const char* const begin = port->data();
  const char* const end = begin + port->size();
  const auto [rest, error] = std::from_chars(begin, end, out.port);
  if (error != std::errc() || rest != end || out.port < ports.lowest) {
    return failure("the port is not a number from " + std::to_string(ports.lowest) + " to 65535");
  }
  return out;
}

Parsed parse(std::string_view text, Ports ports) {
  if (text.starts_with('[')) {
    const std::size_t bracket = text.find(']');
    if (bracket == std::string_view::npos) return wrong_form();
    const std::string_view host = text.substr(1, bracket - 1);
    if (!may_be_v6(host)) return wrong_form();
    const std::string_view rest = text.substr(bracket + 1);
    if (rest.empty()) return with_port(host, std::nullopt, ports);
    if (rest.front() != ':') return wrong_form();
    return with_port(host, rest.substr(1), ports);
  }
  const std::size_t colon = text.find(':');
  const bool has_two_colons = colon != text.rfind(':');
  if (text.empty() || (has_two_colons ? !may_be_v6(text) : colon == 0)) return wrong_form();
  if (colon == std::string_view::npos || has_two_colons) {
    return with_port(text, std::nullopt, ports);
  }
  return with_port(text.substr(0, colon), text.substr(colon + 1), ports);
}

}  // namespace

std::string to_string(const HostPort& address) {
  const bool is_v6 = address.host.find(':') != std::string::npos;
  return (is_v6 ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port);
}

Result<HostPort, std::string> parse_host_port(std::string_view text, std::uint16_t default_port) {
  return parse(text, {default_port, 1});
}

Result<std::vector<HostPort>, std::string> parse_host_ports(std::string_view text,
                                                            std::uint16_t default_port) {
  std::vector<HostPort> out;
  for (bool goes_on = true; goes_on;) {
    const std::size_t comma = text.find(',');
    auto address = parse_host_port(text.substr(0, comma), default_port);
    if (!address) return failure(address.error());
    out.push_back(*std::move(address));
    goes_on = comma != std::string_view::npos;
    if (goes_on) text.remove_prefix(comma + 1);
  }
  return out;
}

Result<HostPort, std::string> parse_listen_address(std::string_view text,
                                                   std::uint16_t default_port) {
  const bool is_any = text.starts_with(':') && text.rfind(':') == 0;
  return parse(is_any ? "0.0.0.0" + std::string(text) : std::string(text), {default_port, 0});
}

}  // namespace runstone
