// RightsTable: the records that a compaction moved out of the log because they are needed as they
// are (`rights_record`): changes of rights, and textures. Who may do what, and what materials show,
// follows from them and from the log.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "common/edits/descriptor/edit_record.hpp"
#include "common/sql/database.hpp"
#include "server/store/meta_table.hpp"
#include "server/store/player_table.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

class RightsTable {
 public:
  static StoreResult<RightsTable> open(sql::Database& database);

  /// Returns all records in the order of the log. Each row is verified.
  StoreResult<FoldedRows<EditRecord>> records();
  /// Adds a record, in the caller's transaction, and updates the fold of `rights_record`.
  StoreResult<void> add(const EditRecord& record, RowFold& fold);

 private:
  RightsTable(std::string file, sql::Statement all, sql::Statement insert)
      : file_(std::move(file)), all_(std::move(all)), insert_(std::move(insert)) {}

  std::string file_;
  sql::Statement all_, insert_;
};

}  // namespace runstone
