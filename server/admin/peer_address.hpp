// The address at which the other servers of a world in a database reach this one.
#pragma once
#include <cstdint>
#include <string>

#include "server/admin/server_config.hpp"

namespace runstone {

/// Returns HOST:PORT, or [V6]:PORT. The host is the first of these that there is:
///   - that of the setting `peer_address`, with the port of the setting if it has one;
///   - that of `listen`, unless it stands for every address of the machine;
///   - the machine's host name.
/// `port`: the one that the server listens at.
std::string peer_address_of(const ServerConfig& config, std::uint16_t port);

}  // namespace runstone
