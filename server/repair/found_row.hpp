// FoundRow: a row that its own checksum proves, wherever its bytes were found. The checksum has 64
// bits and covers the name of the table. So other bytes pass for a row with a probability of 2^-64.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "common/sql/database.hpp"
#include "server/repair/stored_row.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

/// The tables whose rows a repair looks for. It makes the rows of all other tables again.
enum class FoundTable {
  meta,
  edit_log,
  player,
  player_instance,
  player_name,
  name_claim,
  rights_record,
  base,
  snapshot,
  build,
  build_part
};

/// The columns of a table, as they are stored.
struct FoundColumns {
  FoundTable table;
  const char* name;
  std::string_view columns;  // separated by ", "
  // The type of each column: i integer, t text, b blob, v any of them.
  std::string_view types;
  std::size_t checksum;  // the column of the checksum
};
std::span<const FoundColumns> found_tables();
const FoundColumns& columns_of(FoundTable table);

/// Finds the table of a row. Threads: the one that owns the database.
class RowProof {
 public:
  /// The database must outlive the object. It needs no tables.
  static StoreResult<RowProof> open(sql::Database& database);

  /// Returns the table whose row this is, or nullopt if no checksum proves it.
  StoreResult<std::optional<FoundTable>> table_of(const StoredRow& row);
  /// Returns the table that a row with these columns may be from, although its checksum is wrong.
  /// Returns nullopt if it is of no table, or if several tables or indexes have such columns.
  static std::optional<FoundTable> likely_table_of(const StoredRow& row);

 private:
  explicit RowProof(sql::Statement record) : record_(std::move(record)) {}
  StoreResult<bool> proves(const FoundColumns& table, const StoredRow& row);

  sql::Statement record_;  // returns its parameters as the columns of a record of the log
};

/// Binds a column of a row to a parameter. Requires that it is not NULL.
void bind_value(sql::Statement& into, int parameter, const StoredValue& value);

}  // namespace runstone
