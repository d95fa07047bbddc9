#include "server/settings/address_check.hpp"

#include <algorithm>
#include <string_view>

#include "common/os/host_port.hpp"
#include "protocol/codec/server_list.hpp"
#include "protocol/default_port.hpp"

namespace runstone {
namespace {

constexpr std::string_view kRule = "must be HOST, HOST:PORT or [V6]:PORT";

/// Returns the part between "https://" and the first slash behind it.
std::string_view host_in(std::string_view text) {
  const std::size_t scheme = text.find("://");
  if (scheme != std::string_view::npos) text.remove_prefix(scheme + 3);
  return text.substr(0, text.find_first_of("/?#"));
}

/// Fails with the rule and, if there is an address within the text, with that address.
Unexpected<std::string> wrong(std::string_view text, std::string_view why) {
  std::string line = std::string(kRule) + ": " + std::string(why);
  const std::string_view host = host_in(text);
  if (host.size() != text.size() && parse_host_port(host, kDefaultPort))
    line += "; write " + std::string(host);
  return failure(std::move(line));
}

}  // namespace

Result<void, std::string> check_peer_address(const std::string& text) {
  if (text.find("://") != std::string::npos)
    return wrong(text, "it is no address of the web such as https://HOST");
  if (text.find_first_of("/?#") != std::string::npos) return wrong(text, "it has no path");
  const auto is_blank = [](unsigned char c) { return c <= ' ' || c == 0x7f; };
  if (std::any_of(text.begin(), text.end(), is_blank)) return wrong(text, "it has no blanks");
  const auto address = parse_host_port(text, kDefaultPort);
  if (!address) return failure(address.error());
  return {};
}

Result<void, std::string> check_public_address(const std::string& text) {
  if (auto checked = check_peer_address(text); !checked) return checked;
  if (is_player_address(to_string(*parse_host_port(text, kDefaultPort)))) return {};
  return wrong(text,
               "the host has the letters a to z, digits, dots and hyphens, so a name in other "
               "letters is written in its form xn--");
}

}  // namespace runstone
