#include "server/store/player_table.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "server/store/world_schema.hpp"

namespace runstone {

namespace {

std::int64_t checksum_of(std::int64_t author, ByteView key, std::string_view name) {
  return RowChecksum("player").integer(author).blob(key).text(name).value();
}

std::int64_t checksum_of(std::int64_t author, std::int64_t instance, std::int64_t decided) {
  return RowChecksum("player_instance").integer(author).integer(instance).integer(decided).value();
}

}  // namespace

StoreResult<PlayerTable> PlayerTable::open(sql::Database& database) {
  auto players = database.prepare("SELECT author, key, name, checksum FROM player ORDER BY author");
  if (!players) return Unexpected<StoreError>{players.error()};
  auto marks = database.prepare(
      "SELECT author, instance, decided, checksum FROM player_instance ORDER BY author, instance");
  if (!marks) return Unexpected<StoreError>{marks.error()};
  auto put = database.prepare(
      "INSERT INTO player(author, key, name, checksum) VALUES(?1, ?2, ?3, ?4) "
      "ON CONFLICT(author) DO UPDATE SET key = excluded.key, name = excluded.name, checksum = "
      "excluded.checksum");
  if (!put) return Unexpected<StoreError>{put.error()};
  auto raise = database.prepare(
      "INSERT INTO player_instance(author, instance, decided, checksum) VALUES(?1, ?2, ?3, ?4) "
      "ON CONFLICT(author, instance) DO UPDATE SET decided = excluded.decided, checksum = excluded.checksum "
      "WHERE excluded.decided > decided");
  if (!raise) return Unexpected<StoreError>{raise.error()};
  return PlayerTable(database.file(), *std::move(players), *std::move(marks), *std::move(put),
                     *std::move(raise));
}

StoreResult<std::vector<PlayerRow>> PlayerTable::players() {
  const sql::ResetAtEnd reset_at_end(players_);
  std::vector<PlayerRow> rows;
  for (;;) {
    const auto more = players_.step();
    if (!more) return Unexpected<StoreError>{more.error()};
    if (!*more) return rows;
    const std::int64_t author = players_.integer(0);
    const ByteView key = players_.blob(1);
    PlayerRow row;
    row.name = players_.text(2);
    if (players_.integer(3) != checksum_of(author, key, row.name) || author < 1 ||
        author > std::numeric_limits<AuthorId>::max() || key.size() != row.key.size()) {
      return Unexpected<StoreError>{
          {StoreError::Kind::corrupt, file_, "player author=" + std::to_string(author), "checksum is wrong"}};
    }
    row.author = static_cast<AuthorId>(author);
    std::copy(key.begin(), key.end(), row.key.begin());
    rows.push_back(std::move(row));
  }
}

StoreResult<std::vector<HighWater>> PlayerTable::high_waters() {
  const sql::ResetAtEnd reset_at_end(marks_);
  std::vector<HighWater> rows;
  for (;;) {
    const auto more = marks_.step();
    if (!more) return Unexpected<StoreError>{more.error()};
    if (!*more) return rows;
    const std::int64_t author = marks_.integer(0);
    const std::int64_t instance = marks_.integer(1);
    const std::int64_t decided = marks_.integer(2);
    if (marks_.integer(3) != checksum_of(author, instance, decided) || author < 0 ||
        author > std::numeric_limits<AuthorId>::max()) {
      return Unexpected<StoreError>{{StoreError::Kind::corrupt, file_,
                                     "player_instance author=" + std::to_string(author) +
                                         " instance=" + std::to_string(static_cast<ClientInstance>(instance)),
                                     "checksum is wrong"}};
    }
    rows.push_back({static_cast<AuthorId>(author), static_cast<ClientInstance>(instance),
                    static_cast<ClientSequence>(decided)});
  }
}

StoreResult<void> PlayerTable::put(const PlayerRow& player) {
  return put_.bind(1, std::int64_t{player.author})
      .bind(2, ByteView(player.key))
      .bind(3, std::string_view(player.name))
      .bind(4, checksum_of(player.author, player.key, player.name))
      .run();
}

StoreResult<void> PlayerTable::raise(const HighWater& mark) {
  const auto instance = static_cast<std::int64_t>(mark.instance);
  const auto decided = static_cast<std::int64_t>(mark.decided);
  return raise_.bind(1, std::int64_t{mark.author})
      .bind(2, instance)
      .bind(3, decided)
      .bind(4, checksum_of(mark.author, instance, decided))
      .run();
}

}  // namespace runstone
