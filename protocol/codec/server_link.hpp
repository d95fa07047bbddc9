// Server link: an address that players pass on, with an invite if there is one:
// runstone://HOST:PORT or runstone://HOST:PORT/#INVITE. What stands behind # is a secret of those
// who have the link.
#pragma once
#include <string>
#include <string_view>

#include "common/core/result.hpp"

namespace runstone {

struct ServerLink {
  std::string address;  // HOST or HOST:PORT; not checked
  std::string ticket;   // an invite token; empty: none
  friend bool operator==(const ServerLink&, const ServerLink&) = default;
};

std::string text_of(const ServerLink& link);

/// Takes a link; what stands before the address may be missing. The error is a sentence about the
/// text.
Result<ServerLink, std::string> parse_server_link(std::string_view text);

}  // namespace runstone
