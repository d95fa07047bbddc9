// The answer of the command `servers`.
#pragma once
#include <string>
#include <vector>

#include "server/world/cluster/handover.hpp"

namespace runstone {

/// Returns one line per server, in the order of `servers`: number, address for players, open sessions,
/// and edits of its players.
std::string server_list(const std::vector<KnownServer>& servers);

}  // namespace runstone
