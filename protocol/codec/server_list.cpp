#include "protocol/codec/server_list.hpp"

#include <algorithm>
#include <charconv>

namespace runstone {
namespace {

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// Returns true if the text is not empty, and each character is a letter, a digit or one of
/// `others`.
bool has_only(std::string_view text, std::string_view others) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [others](char c) {
    return is_letter_or_digit(c) || others.find(c) != std::string_view::npos;
  });
}

bool is_host(std::string_view text) {
  if (!text.starts_with('[')) return has_only(text, ".-_");
  if (!text.ends_with(']')) return false;
  const std::string_view v6 = text.substr(1, text.size() - 2);
  return v6.find(':') != std::string_view::npos &&
         v6.find_first_not_of("0123456789abcdefABCDEF:.") == std::string_view::npos;
}

bool is_port(std::string_view text) {
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, port);
  return error == std::errc() && rest == end && port != 0;
}

/// Returns where the colon of the port is, or npos.
std::size_t port_colon(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  const bool is_of_v6 = colon != std::string_view::npos && text.find(']', colon) != text.npos;
  return is_of_v6 ? std::string_view::npos : colon;
}

}  // namespace

bool is_player_address(std::string_view text) {
  const std::size_t colon = port_colon(text);
  return text.size() <= kServerAddressBytesMax && colon != std::string_view::npos &&
         is_host(text.substr(0, colon)) && is_port(text.substr(colon + 1));
}

bool is_page_address(std::string_view text) {
  if (text.empty()) return true;
  if (text.size() > kServerAddressBytesMax) return false;
  for (const std::string_view scheme : {"https://", "http://"}) {
    if (!text.starts_with(scheme)) continue;
    const std::string_view rest = text.substr(scheme.size());
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    const std::string_view host = rest.substr(0, slash), path = rest.substr(slash);
    const bool is_path = path.empty() || has_only(path, "/._~-");
    return is_path &&
           (port_colon(host) == std::string_view::npos ? is_host(host) : is_player_address(host));
  }
  return false;
}

Servers seen_from(Servers list, std::string_view address) {
  const auto found =
      std::find_if(list.servers.begin(), list.servers.end(),
                   [address](const ServerEntry& entry) { return entry.address == address; });
  const bool is_listed = found != list.servers.end();
  list.here = static_cast<std::uint8_t>(is_listed ? found - list.servers.begin() + 1 : 0);
  return list;
}

std::vector<ServerEntry> others_of(const Servers& list) {
  std::vector<ServerEntry> others = list.servers;
  if (list.here != 0) others.erase(others.begin() + (list.here - 1));
  return others;
}

std::string web_socket_path(std::string_view page_path) {
  if (page_path.ends_with('/')) page_path.remove_suffix(1);
  return std::string(page_path) + "/play";
}

}  // namespace runstone
