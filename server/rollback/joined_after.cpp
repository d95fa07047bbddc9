#include "server/rollback/joined_after.hpp"

#include <algorithm>

namespace runstone {

StoreResult<std::vector<AuthorId>> joined_after(WorldReader& reader, TimeUs time_us) {
  const auto players = reader.players();
  if (!players) return failure(players.error());
  // A compaction keeps watermarks. They show an author whose early edits it has removed.
  const auto marks = reader.high_waters();
  if (!marks) return failure(marks.error());
  AuthorId known = 0;  // the greatest number that was given by then
  for (const HighWater& mark : *marks) {
    if (mark.last_us <= time_us) known = std::max(known, mark.author);
  }
  std::vector<AuthorId> out;
  for (auto player = players->rbegin(); player != players->rend(); ++player) {
    if (player->author <= known) break;
    LogQuery first;
    first.author = player->author;
    bool had_joined = false;
    const auto read = reader.query_log(first, [&](const EditRecord& record) {
      had_joined = record.time_us <= time_us;
      return false;
    });
    if (!read) return failure(read.error());
    if (had_joined) break;
    out.push_back(player->author);
  }
  std::ranges::reverse(out);
  return out;
}

}  // namespace runstone
