#include "protocol/codec/server_link.hpp"

#include <algorithm>

#include "common/core/text.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

constexpr std::string_view kScheme = "runstone://";

}  // namespace

std::string text_of(const ServerLink& link) {
  std::string text = std::string(kScheme) + link.address;
  if (!link.ticket.empty()) text += "/#" + link.ticket;
  return text;
}

Result<ServerLink, std::string> parse_server_link(std::string_view text) {
  const std::string_view rest = text.starts_with(kScheme) ? text.substr(kScheme.size()) : text;
  const std::size_t address_ends = std::min(rest.find_first_of("/#"), rest.size());
  const std::size_t hash = rest.find('#');
  ServerLink link{std::string(rest.substr(0, address_ends)), ""};
  if (link.address.empty()) return failure("the link names no server");
  const std::string_view path =
      rest.substr(address_ends, std::min(hash, rest.size()) - address_ends);
  if (path != "" && path != "/") return failure("a link is runstone://HOST:PORT/#INVITE");
  if (hash == std::string_view::npos) return link;
  link.ticket = rest.substr(hash + 1);
  if (link.ticket.empty() || link.ticket.size() > kTicketBytesMax ||
      !is_printable_utf8(link.ticket))
    return failure("the text after # in the link is not an invite");
  return link;
}

}  // namespace runstone
