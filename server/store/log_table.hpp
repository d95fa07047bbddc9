// LogTable: the edit log on disk, one row per edit, keyed by (log, sequence) without gaps. Log 0 is the only
// one. Where it begins is in `meta`: what lies before was compacted into the base.
#pragma once
#include <functional>
#include <string>

#include "common/sqlite/database.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

class LogTable {
 public:
  /// The database must outlive the table.
  static StoreResult<LogTable> open(sql::Database& database);

  /// What the log holds, given the end of what was compacted away. Fails (corrupt) if the rows do not begin
  /// right behind it. Both must be read in one transaction. Reads the disk: O(log n).
  StoreResult<LogRange> range(const LogEnd& head);
  /// In the caller's transaction. The caller has checked that the record continues the log.
  StoreResult<void> insert(const EditRecord& record);
  /// As Store::read_log(). May be nested.
  StoreResult<void> read(const LogRange& range, Sequence first, Sequence last,
                         const std::function<bool(const EditRecord&)>& each);

  /// A statement for read_one(), which may be used for many records.
  StoreResult<sql::Statement> reader();
  /// Record `seq`, verified as in read().
  StoreResult<EditRecord> read_one(sql::Statement& reader, Sequence seq);

 private:
  LogTable(sql::Database& database, sql::Statement first, sql::Statement last,
           sql::Statement insert)
      : database_(&database),
        first_(std::move(first)),
        last_(std::move(last)),
        insert_(std::move(insert)) {}
  Unexpected<StoreError> corrupt(Sequence seq, std::string what) const;

  sql::Database* database_;
  sql::Statement first_, last_, insert_;
};

}  // namespace runstone
