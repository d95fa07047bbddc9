// PlayerTable: the players with their author numbers (`player`), and the watermark of each of their
// client instances (`player_instance`). The watermarks make sure that an edit that is offered twice
// is applied once.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/sql/database.hpp"
#include "server/store/folded_rows.hpp"
#include "server/store/store_error.hpp"
#include "server/world/environment/player_rows.hpp"

namespace runstone {

class PlayerTable {
 public:
  static StoreResult<PlayerTable> open(sql::Database& database);

  /// Returns all players, ascending by author. Each row is verified.
  StoreResult<FoldedRows<PlayerRow>> players();
  /// Returns all watermarks, ascending by author, then by instance as a signed number. Each row is
  /// verified.
  StoreResult<FoldedRows<HighWater>> high_waters();

  /// Writes a new author, or the new name of a known one, in the caller's transaction, and updates
  /// the fold of `player`.
  StoreResult<void> put(const PlayerRow& player, RowFold& fold);
  /// Raises a watermark and its time, in the caller's transaction, and updates the fold of
  /// `player_instance`. It never lowers them. Fails (corrupt) if the row is damaged, and leaves it
  /// as it is.
  StoreResult<void> raise(HighWater mark, RowFold& fold);
  /// Forgets what raise() keeps in memory. Call it after a transaction that was rolled back.
  void forget() { raised_.clear(); }

 private:
  PlayerTable(const sql::Database& database, sql::Statement players, sql::Statement player,
              sql::Statement marks, sql::Statement mark, sql::Statement put, sql::Statement raise)
      : file_(database.file()),
        keeps_raised_(database.dialect() == sql::Dialect::postgres),
        players_(std::move(players)),
        player_(std::move(player)),
        marks_(std::move(marks)),
        mark_(std::move(mark)),
        put_(std::move(put)),
        raise_(std::move(raise)) {}

  StoreResult<PlayerRow> player_of(const sql::Statement& row) const;
  StoreResult<HighWater> mark_of(const sql::Statement& row) const;
  /// Returns the watermark that is stored for the client of `mark`, or nullopt.
  StoreResult<std::optional<HighWater>> stored_mark(const HighWater& mark);

  std::string file_;
  /// The watermarks that were raised last, so that the next edits of their clients wait for no row
  /// of PostgreSQL. SQLite has its pages in memory, and each row is verified before it is replaced.
  bool keeps_raised_;
  std::map<std::pair<AuthorId, ClientInstance>, HighWater> raised_;
  sql::Statement players_, player_, marks_, mark_, put_, raise_;
};

}  // namespace runstone
