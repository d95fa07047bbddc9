#include "server/admin/player_list.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>

#include "common/core/hex.hpp"
#include "common/core/key_text.hpp"
#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {
namespace {

constexpr std::size_t kAbsentListed = 500;

std::string line_of(const PlayerRow& row) {
  return row.name + " #" + std::to_string(row.author) + " " + key_fingerprint(row.key) + " key " +
         to_hex(row.key);
}

std::int32_t voxel_of(double coordinate) {
  return static_cast<std::int32_t>(std::floor(coordinate));
}

}  // namespace

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
    lines[player.author] =
        line_of({player.author, player.key, player.name}) + " is here, at " +
        text_of(VoxelPos{voxel_of(player.at.x), voxel_of(player.at.y), voxel_of(player.at.z)});
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

}  // namespace runstone
