#include "client/net/link_target.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "protocol/default_port.hpp"

namespace runstone {
namespace {

std::optional<LinkTarget> gateway_target(const ServerEntry& entry, bool is_encrypted) {
  constexpr std::uint16_t kHttpPort = 80, kHttpsPort = 443;
  const std::string_view scheme = is_encrypted ? "https://" : "http://";
  if (!entry.page.starts_with(scheme)) return std::nullopt;
  const std::string_view rest = std::string_view(entry.page).substr(scheme.size());
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  auto server = parse_host_port(rest.substr(0, slash), is_encrypted ? kHttpsPort : kHttpPort);
  if (!server) return std::nullopt;
  return LinkTarget{*std::move(server), web_socket_path(rest.substr(slash))};
}

}  // namespace

std::vector<LinkTarget> other_servers(const Servers& list) {
  std::vector<LinkTarget> out;
  for (const ServerEntry& entry : others_of(list)) {
    if (auto server = parse_host_port(entry.address, kDefaultPort))
      out.push_back({*std::move(server), ""});
  }
  return out;
}

std::vector<LinkTarget> other_gateways(const Servers& list, bool is_encrypted) {
  std::vector<LinkTarget> out;
  for (const ServerEntry& entry : others_of(list)) {
    if (auto target = gateway_target(entry, is_encrypted)) out.push_back(*std::move(target));
  }
  return out;
}

}  // namespace runstone
