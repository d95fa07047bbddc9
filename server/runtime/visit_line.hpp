// The log lines about players who come and leave.
#pragma once
#include <string>

#include "server/net/net_session.hpp"
#include "server/world/world_environment.hpp"

namespace runstone {

/// Return payloads (log_payload.hpp). `address` is peer_text() of the player's connection.
std::string came_line(const PlayerVisit& visit, const std::string& address);
std::string left_line(const PlayerVisit& visit, const EndCause& end);

/// Returns the first 16 hexadecimal digits of a key: enough to tell players apart, and to find one
/// in the list of the command `players`.
std::string key_fingerprint(const PublicKey& key);

}  // namespace runstone
