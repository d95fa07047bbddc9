// The addresses of servers in settings, which people copy from a browser or a mail. Thread: any.
#pragma once
#include <string>

#include "common/core/result.hpp"

namespace runstone {

/// Fails if a text is no address that another program can connect to: HOST, HOST:PORT, V6 or
/// [V6]:PORT. The error is what is wrong, and what to write instead of an address of the web.
Result<void, std::string> check_peer_address(const std::string& text);
/// Fails like check_peer_address(), and if the address cannot stand in a link or in the list of
/// servers (is_player_address()).
Result<void, std::string> check_public_address(const std::string& text);

}  // namespace runstone
