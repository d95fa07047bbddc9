// LogTable: the edit log on disk, one row per edit, keyed by (log, sequence) without gaps. Log 0 is the only
// one.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "server/store/sql.hpp"
#include "server/store/store.hpp"

namespace runstone {

class LogTable {
 public:
  /// The database must outlive the table.
  static StoreResult<LogTable> open(sql::Database& database);

  /// Version of the last record; nothing while the log is empty. Reads the disk: O(log n).
  StoreResult<std::optional<Version>> last();
  /// In the caller's transaction. The caller has checked that the record continues the log.
  StoreResult<void> insert(const EditRecord& record);
  /// As Store::read_log(). May be nested.
  StoreResult<void> read(Sequence first, Sequence last, const std::function<bool(const EditRecord&)>& each);

 private:
  LogTable(sql::Database& database, sql::Statement last, sql::Statement insert)
      : database_(&database), last_(std::move(last)), insert_(std::move(insert)) {}
  Unexpected<StoreError> corrupt(Sequence seq, std::string what) const;

  sql::Database* database_;
  sql::Statement last_, insert_;
};

}  // namespace runstone
