// NameTable: the names that the players have used (`player_name`), so that an operator finds a
// player by an earlier name. A player's names are numbered in the order of their first use, and the
// last kNamesPerAuthorMax are kept. The name in use is also in `player`.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/sql/database.hpp"
#include "server/store/store_error.hpp"
#include "server/world/environment/player_rows.hpp"

namespace runstone {

inline constexpr std::int64_t kNamesPerAuthorMax = 16;

class NameTable {
 public:
  static StoreResult<NameTable> open(sql::Database& database);

  /// Returns all names, ascending by author, then by first use. Each row is verified.
  StoreResult<std::vector<UsedName>> names();
  /// Adds a name unless the author has it, and removes the oldest one beyond the bound, in the
  /// caller's transaction. Returns by how many the number of rows has changed. Fails (corrupt), and
  /// changes nothing, if a row of the author is damaged.
  StoreResult<std::int64_t> add(const UsedName& name);

 private:
  NameTable(std::string file, sql::Statement all, sql::Statement by_author, sql::Statement insert,
            sql::Statement drop)
      : file_(std::move(file)),
        all_(std::move(all)),
        by_author_(std::move(by_author)),
        insert_(std::move(insert)),
        drop_(std::move(drop)) {}

  StoreResult<UsedName> name_of(const sql::Statement& row) const;

  std::string file_;
  sql::Statement all_, by_author_, insert_, drop_;
};

}  // namespace runstone
