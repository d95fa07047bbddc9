// The address at which players reach one of the servers of a world in a database.
#pragma once
#include <cstdint>
#include <string>

#include "server/admin/server_config.hpp"

namespace runstone {

/// Returns HOST:PORT, or [V6]:PORT: the setting `player_address`, with `port` if it has none. Returns an
/// empty text if the setting is empty. `port`: the one that the server listens at.
std::string player_address_of(const ServerConfig& config, std::uint16_t port);

}  // namespace runstone
