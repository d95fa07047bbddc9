// The log lines about players who come and leave.
#pragma once
#include <string>

#include "server/net/net_session.hpp"
#include "server/world/environment/world_environment.hpp"

namespace runstone {

/// Return payloads (log_payload.hpp). `address` is peer_text() of the player's connection.
std::string came_line(const PlayerVisit& visit, const std::string& address);
std::string left_line(const PlayerVisit& visit, const EndCause& end);

}  // namespace runstone
