// Server list: the servers of one world at which players may connect. A client whose server ends
// connects to another one of them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/limits.hpp"

namespace runstone {

struct ServerEntry {
  std::string address;    // is_player_address()
  std::string page = {};  // is_page_address(); empty: browsers do not reach this server
  std::uint32_t players = 0;
  friend bool operator==(const ServerEntry&, const ServerEntry&) = default;
};

/// The servers that run now. It is sent each time that they change.
struct Servers {
  std::vector<ServerEntry> servers;  // 0 .. kServersMax, strictly ascending by address
  std::uint8_t here = 0;             // number of the sender's entry, from 1; 0: it has none
  friend bool operator==(const Servers&, const Servers&) = default;
};

/// Returns true if the text is HOST:PORT or [V6]:PORT with a port from 1 to 65535, and has
/// kServerAddressBytesMax bytes at most. A HOST has ASCII letters, digits, dots, hyphens and
/// underscores. A V6 has no zone.
bool is_player_address(std::string_view text);
/// Returns true if the text is empty, or is http://HOST or https://HOST, perhaps with a port and a
/// path, and has kServerAddressBytesMax bytes at most. A path has letters, digits and any of
/// "/._~-".
bool is_page_address(std::string_view text);

/// Returns the list with `here` set to the entry of this address.
Servers seen_from(Servers list, std::string_view address);
/// Returns the servers besides the sender of the list.
std::vector<ServerEntry> others_of(const Servers& list);
/// Returns the path of the WebSocket of a gateway, such as "/world/valley/play". `page_path`: of
/// the address of its page, with or without a slash at the end.
std::string web_socket_path(std::string_view page_path);

}  // namespace runstone
