#include "server/admin/server_list.hpp"

#include "server/rollback/count_text.hpp"

namespace runstone {

std::string server_list(const std::vector<KnownServer>& servers) {
  std::string text;
  for (const KnownServer& server : servers) {
    text += text.empty() ? "" : "\n";
    text += server.link ? "server " + std::to_string(*server.link) : "this server, the owner";
    if (!server.player_address.empty()) text += " at " + server.player_address;
    text += ": " + counted(server.players, "session") + ", " + counted(server.edits, "edit") +
            (server.link ? " since it connected" : " since it owns the world");
  }
  return text;
}

}  // namespace runstone
