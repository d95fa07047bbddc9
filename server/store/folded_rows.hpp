// FoldedRows: all rows of a table whose fold is the sum of their checksums. Internal to the store
// and to the repair.
#pragma once
#include <utility>
#include <vector>

#include "common/sql/database.hpp"
#include "server/store/meta_table.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

/// All rows of a table, and their fold.
template <class Row>
struct FoldedRows {
  std::vector<Row> rows;
  RowFold fold;
};

/// Reads the rows of a statement. `checksum` is the column of the checksum. `take(row, rows)`
/// verifies the current row and appends it; it returns StoreResult<void>. Fails as `take`.
template <class Row, class Take>
StoreResult<FoldedRows<Row>> read_folded_rows(sql::Statement& statement, int checksum, Take take) {
  const sql::ResetAtEnd reset_at_end(statement);
  FoldedRows<Row> out;
  for (;;) {
    const auto more = statement.step();
    if (!more) return failed(more.error());
    if (!*more) return out;
    if (const auto taken = take(statement, out.rows); !taken) return failed(taken.error());
    add_row(out.fold, statement.integer(checksum));
  }
}

/// Appends a row that was verified, or returns its error.
template <class Row>
StoreResult<void> append_row(StoreResult<Row> row, std::vector<Row>& rows) {
  if (!row) return failed(row.error());
  rows.push_back(*std::move(row));
  return {};
}

}  // namespace runstone
