// KeptRecords: the table of the records that a compaction moved out of the log because they are
// needed as they are (`rights_record`): changes of rights, and textures. The rights of players and
// the pictures of materials follow from them and from the log.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/edits/descriptor/edit_record.hpp"
#include "common/sql/database.hpp"
#include "server/store/folded_rows.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

class KeptRecords {
 public:
  static StoreResult<KeptRecords> open(sql::Database& database);

  /// Returns the records in the order of the log, and the fold of all rows. Each checksum is
  /// verified. If a cause is given, only the records of this cause are decoded and returned.
  StoreResult<FoldedRows<EditRecord>> records(std::optional<Cause> cause = std::nullopt);
  /// Adds a record, in the caller's transaction, and updates the fold of `rights_record`.
  StoreResult<void> add(const EditRecord& record, RowFold& fold);

 private:
  KeptRecords(std::string file, sql::Statement all, sql::Statement insert)
      : file_(std::move(file)), all_(std::move(all)), insert_(std::move(insert)) {}

  std::string file_;
  sql::Statement all_, insert_;
};

}  // namespace runstone
