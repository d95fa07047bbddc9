// The addresses of one of the servers of a world in a database. `port`: the one that it listens at.
#pragma once
#include <cstdint>
#include <string>

#include "server/admin/server_config.hpp"

namespace runstone {

/// Returns the address for players, HOST:PORT or [V6]:PORT: the setting `player_address`, with
/// `port` if it has none. Returns an empty text if the setting is empty.
std::string player_address_of(const ServerConfig& config, std::uint16_t port);

/// Returns the address for the other servers, HOST:PORT or [V6]:PORT. The host is the first of
/// these that there is:
///   - that of the setting `peer_address`, with the port of the setting if it has one;
///   - that of `listen`, unless it stands for every address of the machine;
///   - the machine's host name.
std::string peer_address_of(const ServerConfig& config, std::uint16_t port);

}  // namespace runstone
