// The answer of the command `players`.
#pragma once
#include <string>
#include <vector>

#include "server/world/environment/player_rows.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

/// Returns one line per player with name, author number, fingerprint and key, ascending by author number. The
/// line of a player who is present has the position. The line of a visitor says that the visitor
/// left. Anybody can make any number of keys, so at most 500 players of the store who are not
/// present are listed; a last line counts the others.
std::string player_list(const std::vector<PlayerRow>& stored,
                        const std::vector<OnlinePlayer>& present,
                        const std::vector<PlayerRow>& visitors);

}  // namespace runstone
