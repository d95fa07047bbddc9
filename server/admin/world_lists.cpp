#include "server/admin/world_lists.hpp"

#include <cstddef>
#include <cstdint>
#include <map>

#include "common/core/hex.hpp"
#include "common/core/key_text.hpp"
#include "common/core/utc_text.hpp"
#include "common/core/world_pos.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "server/rollback/count_text.hpp"

namespace runstone {
namespace {

constexpr std::size_t kNamesListed = 1000;
constexpr std::size_t kAbsentListed = 500;

std::string line_of(const PlayerRow& row) {
  return row.name + " #" + std::to_string(row.author) + " " + key_fingerprint(row.key) + " key " +
         to_hex(row.key);
}

}  // namespace

std::string material_list(const MaterialTable& materials, std::string_view part) {
  std::string text;
  std::size_t matches = 0;
  for (const MaterialInfo& material : materials.rows()) {
    if (material.name.find(part) == std::string::npos) continue;
    if (++matches <= kNamesListed) text += material.name + "\n";
  }
  if (matches == 0) return "no material's name contains \"" + std::string(part) + "\"";
  if (matches > kNamesListed) {
    text += "and " + std::to_string(matches - kNamesListed) + " more: materials PART\n";
  }
  text.pop_back();
  return text;
}

std::string player_list(const std::vector<PlayerRow>& stored,
                        const std::vector<OnlinePlayer>& present,
                        const std::vector<PlayerRow>& visitors) {
  std::map<AuthorId, std::string> lines;
  for (const PlayerRow& row : stored) {
    if (lines.size() == kAbsentListed) break;
    lines[row.author] = line_of(row);
  }
  for (const PlayerRow& row : visitors) lines[row.author] = line_of(row) + " left without an edit";
  for (const OnlinePlayer& player : present) {
    lines[player.author] = line_of({player.author, player.key, player.name}) + " is here, at " +
                           text_of(voxel_of_point(player.at));
  }
  std::size_t unlisted = stored.size();
  for (const PlayerRow& row : stored) unlisted -= lines.contains(row.author) ? 1 : 0;
  std::string text;
  for (const auto& [author, line] : lines) text += line + "\n";
  if (text.empty()) return "nobody has ever been here";
  if (unlisted > 0) text += "and " + std::to_string(unlisted) + " more who are not here\n";
  text.pop_back();
  return text;
}

std::string name_list(const std::vector<OwnedName>& owned) {
  constexpr std::size_t kListed = 500;
  if (owned.empty()) return "nobody owns a name";
  std::string text;
  for (std::size_t i = 0; i < owned.size() && i < kListed; ++i) {
    const OwnedName& name = owned[i];
    text += "\"" + name.name + "\" " + key_fingerprint(name.key);
    if (name.author) text += " #" + std::to_string(*name.author);
    text += "\n";
  }
  if (owned.size() > kListed) text += "and " + std::to_string(owned.size() - kListed) + " more\n";
  text.pop_back();
  return text;
}

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

std::string chat_list(const std::vector<ChatEntry>& entries) {
  if (entries.empty()) return "the log of the chat has no such lines";
  std::string text;
  for (const ChatEntry& entry : entries) {
    const bool is_of_server = entry.line.kind == ChatLineKind::server;
    if (!text.empty()) text += "\n";
    text += utc_text(entry.line.utc_us) + " " + (is_of_server ? "server" : entry.line.name);
    if (entry.key != PublicKey{}) text += " " + key_fingerprint(entry.key);
    text += (entry.is_withdrawn ? " (withdrawn): " : ": ") + entry.line.text;
  }
  return text;
}

}  // namespace runstone
