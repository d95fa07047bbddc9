#include "server/store/player_table.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

namespace {

std::int64_t checksum_of(std::int64_t author, ByteView key, std::string_view name) {
  return RowChecksum("player").integer(author).blob(key).text(name).value();
}

std::int64_t checksum_of(std::int64_t author, std::int64_t instance, std::int64_t resolved,
                         std::int64_t last_us) {
  return RowChecksum("player_instance")
      .integer(author)
      .integer(instance)
      .integer(resolved)
      .integer(last_us)
      .value();
}

std::int64_t checksum_of(const HighWater& mark) {
  return checksum_of(std::int64_t{mark.author}, static_cast<std::int64_t>(mark.instance),
                     static_cast<std::int64_t>(mark.resolved), mark.last_us);
}

constexpr std::size_t kRaisedMax = 1'024;  // bounds the memory

}  // namespace

StoreResult<PlayerTable> PlayerTable::open(sql::Database& database) {
  auto players = database.prepare("SELECT author, key, name, checksum FROM player ORDER BY author");
  if (!players) return failed(players.error());
  auto player = database.prepare("SELECT checksum FROM player WHERE author = ?1");
  if (!player) return failed(player.error());
  const std::string mark_row =
      "SELECT author, instance, decided, last_us, checksum FROM player_instance";
  auto marks = database.prepare(mark_row + " ORDER BY author, instance");
  if (!marks) return failed(marks.error());
  auto mark = database.prepare(mark_row + " WHERE author = ?1 AND instance = ?2");
  if (!mark) return failed(mark.error());
  auto put = database.prepare(
      "INSERT INTO player(author, key, name, checksum) VALUES(?1, ?2, ?3, ?4) ON CONFLICT(author) "
      "DO UPDATE SET key = excluded.key, name = excluded.name, checksum = excluded.checksum");
  if (!put) return failed(put.error());
  auto raise = database.prepare(
      "INSERT INTO player_instance(author, instance, decided, last_us, checksum) "
      "VALUES(?1, ?2, ?3, ?4, ?5) ON CONFLICT(author, instance) "
      "DO UPDATE SET decided = excluded.decided, last_us = excluded.last_us, "
      "checksum = excluded.checksum");
  if (!raise) return failed(raise.error());
  return PlayerTable(database, *std::move(players), *std::move(player), *std::move(marks),
                     *std::move(mark), *std::move(put), *std::move(raise));
}

StoreResult<PlayerRow> PlayerTable::player_of(const sql::Statement& row) const {
  const std::int64_t author = row.integer(0);
  const ByteView key = row.blob(1);
  PlayerRow player;
  player.name = row.text(2);
  if (row.integer(3) != checksum_of(author, key, player.name) || author < 1 ||
      author > std::numeric_limits<AuthorId>::max() || key.size() != player.key.size()) {
    return failure(StoreError{StoreError::Kind::corrupt, file_,
                              "player author=" + std::to_string(author), "checksum is wrong"});
  }
  player.author = static_cast<AuthorId>(author);
  std::copy(key.begin(), key.end(), player.key.begin());
  return player;
}

StoreResult<FoldedRows<PlayerRow>> PlayerTable::players() {
  return read_folded_rows<PlayerRow>(players_, 3, [this](const auto& row, auto& rows) {
    return append_row(player_of(row), rows);
  });
}

StoreResult<FoldedRows<HighWater>> PlayerTable::high_waters() {
  return read_folded_rows<HighWater>(
      marks_, 4, [this](const auto& row, auto& rows) { return append_row(mark_of(row), rows); });
}

StoreResult<HighWater> PlayerTable::mark_of(const sql::Statement& row) const {
  const std::int64_t author = row.integer(0);
  const std::int64_t instance = row.integer(1);
  const std::int64_t resolved = row.integer(2);
  const std::int64_t last_us = row.integer(3);
  if (row.integer(4) != checksum_of(author, instance, resolved, last_us) || author < 0 ||
      author > std::numeric_limits<AuthorId>::max() || resolved < 0) {
    return failure(StoreError{StoreError::Kind::corrupt, file_,
                              "player_instance author=" + std::to_string(author) + " instance=" +
                                  std::to_string(static_cast<ClientInstance>(instance)),
                              "checksum is wrong"});
  }
  return HighWater{static_cast<AuthorId>(author), static_cast<ClientInstance>(instance),
                   static_cast<ClientSequence>(resolved), last_us};
}

StoreResult<void> PlayerTable::put(const PlayerRow& player, RowFold& fold) {
  {
    const sql::ResetAtEnd reset_at_end(player_);
    const auto found = player_.bind(1, std::int64_t{player.author}).step();
    if (!found) return failed(found.error());
    if (*found) remove_row(fold, player_.integer(0));
  }
  const std::int64_t checksum = checksum_of(player.author, player.key, player.name);
  add_row(fold, checksum);
  return store_result(put_.bind(1, std::int64_t{player.author})
                          .bind(2, ByteView(player.key))
                          .bind(3, std::string_view(player.name))
                          .bind(4, checksum)
                          .run());
}

StoreResult<std::optional<HighWater>> PlayerTable::stored_mark(const HighWater& mark) {
  const auto raised = raised_.find({mark.author, mark.instance});
  if (raised != raised_.end()) return std::optional(raised->second);
  const sql::ResetAtEnd reset_at_end(mark_);
  const auto found = mark_.bind(1, std::int64_t{mark.author})
                         .bind(2, static_cast<std::int64_t>(mark.instance))
                         .step();
  if (!found) return failed(found.error());
  if (!*found) return std::optional<HighWater>();
  const auto stored = mark_of(mark_);
  if (!stored) return failed(stored.error());
  return std::optional(*stored);
}

StoreResult<void> PlayerTable::raise(HighWater mark, RowFold& fold) {
  const auto stored = stored_mark(mark);
  if (!stored) return failed(stored.error());
  if (*stored) {
    mark.resolved = std::max(mark.resolved, (*stored)->resolved);
    mark.last_us = std::max(mark.last_us, (*stored)->last_us);
    remove_row(fold, checksum_of(**stored));
  }
  const std::int64_t checksum = checksum_of(mark);
  add_row(fold, checksum);
  if (keeps_raised_) {
    if (raised_.size() >= kRaisedMax) raised_.clear();
    raised_[{mark.author, mark.instance}] = mark;
  }
  return store_result(raise_.bind(1, std::int64_t{mark.author})
                          .bind(2, static_cast<std::int64_t>(mark.instance))
                          .bind(3, static_cast<std::int64_t>(mark.resolved))
                          .bind(4, mark.last_us)
                          .bind(5, checksum)
                          .run());
}

}  // namespace runstone
