// The answers of the commands `materials`, `players`, `names`, `servers` and `chat log`.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/materials/material_table.hpp"
#include "protocol/codec/messages.hpp"
#include "server/world/cluster/handover.hpp"
#include "server/world/environment/chat_entry.hpp"
#include "server/world/environment/player_rows.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

/// Returns the names of the materials that contain `part`, one per line, in the order of their ids.
/// The material "air" is listed too: edits may set it. A last line counts the names beyond 1000.
std::string material_list(const MaterialTable& materials, std::string_view part);

/// Returns one line per player with name, author number, fingerprint and key, ascending by author
/// number. The line of a player who is present has the position. The line of a visitor says that
/// the visitor left. Anybody can make any number of keys, so at most 500 players of the store who
/// are not present are listed; a last line counts the others.
std::string player_list(const std::vector<PlayerRow>& stored,
                        const std::vector<OnlinePlayer>& present,
                        const std::vector<PlayerRow>& visitors);

struct OwnedName {
  std::string name;
  PublicKey key{};
  std::optional<AuthorId> author;  // nullopt: the owner has never built and is not here
};

/// Returns one line per name, with the fingerprint of the key that owns it and the author number.
/// At most 500 names are listed; a last line counts the others.
std::string name_list(const std::vector<OwnedName>& owned);

/// Returns one line per server, in the order of `servers`: number, address for players, open
/// sessions, and edits of its players.
std::string server_list(const std::vector<KnownServer>& servers);

/// Returns a line for each entry: the time, the name and the fingerprint of the player, and the
/// text.
std::string chat_list(const std::vector<ChatEntry>& entries);

}  // namespace runstone
