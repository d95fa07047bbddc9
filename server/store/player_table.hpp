// PlayerTable: who has an author number (`player`), and how far each of their client processes got
// (`player_instance`): the marks that make an edit offered twice an edit applied once.
#pragma once
#include <string>
#include <vector>

#include "common/sqlite/database.hpp"
#include "server/store/store_error.hpp"
#include "server/world/player_rows.hpp"

namespace runstone {

class PlayerTable {
 public:
  static StoreResult<PlayerTable> open(sql::Database& database);

  /// Ascending by author, each row verified.
  StoreResult<std::vector<PlayerRow>> players();
  /// Ascending by author, then instance (as a signed number), each row verified.
  StoreResult<std::vector<HighWater>> high_waters();

  /// A new author, or the new name of a known one. In the caller's transaction, as raise().
  StoreResult<void> put(const PlayerRow& player);
  /// Moves a mark and its time up; never down. A damaged row is an error and stays as it is.
  StoreResult<void> raise(HighWater mark);

 private:
  PlayerTable(std::string file, sql::Statement players, sql::Statement marks, sql::Statement mark,
              sql::Statement put, sql::Statement raise)
      : file_(std::move(file)),
        players_(std::move(players)),
        marks_(std::move(marks)),
        mark_(std::move(mark)),
        put_(std::move(put)),
        raise_(std::move(raise)) {}

  StoreResult<HighWater> mark_of(const sql::Statement& row) const;

  std::string file_;
  sql::Statement players_, marks_, mark_, put_, raise_;
};

}  // namespace runstone
