// LogTable: the edit log on disk, one row per edit, keyed by (log, sequence) without gaps. Log 0 is
// the only one. `meta` holds the place where the log begins: earlier edits were compacted into the
// base.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/sql/database.hpp"
#include "server/store/log_reader.hpp"
#include "server/world/environment/player_rows.hpp"

namespace runstone {

class LogTable {
 public:
  /// The database must outlive the table.
  static StoreResult<LogTable> open(sql::Database& database);

  /// Returns the extent of the log. `head` is the last edit that was compacted away, read in the
  /// same transaction. Fails (corrupt) if the rows do not begin right after it. Cost: O(log rows).
  StoreResult<LogRange> range(const LogEnd& head);
  /// Inserts records in the caller's transaction. Requires that they continue the log.
  StoreResult<void> insert(std::span<const EditRecord> records);
  /// Reads as LogReader::read_log(). `each` may call it too.
  StoreResult<void> read(const LogRange& range, Sequence first, Sequence last,
                         const std::function<bool(const EditRecord&)>& each);

  /// Calls `each` as LogReader::rows_of_author().
  StoreResult<void> rows_of_author(const LogRange& range, AuthorId author, Sequence last,
                                   const std::function<bool(const LogRow&)>& each);
  /// Returns the authors of edits in the log that `players` lacks, ascending. Cost: O(authors
  /// (log rows + players)), because an index skips from author to author.
  StoreResult<std::vector<AuthorId>> authors_without(const std::vector<PlayerRow>& players);

  /// The columns of a record, in the order that record_in() takes: the sequence is column 0, the
  /// bounding box begins at kBoxColumn, and the descriptor is kDescriptorColumn.
  static constexpr const char* kRecordColumns =
      "seq, epoch, author, instance, client_seq, time_us, cause, subject, min_x, min_y, min_z, "
      "max_x, max_y, max_z, descriptor, checksum";
  static constexpr int kBoxColumn = 8, kDescriptorColumn = 14;
  /// Returns the record of the current row, or nullopt if a column does not decode or the checksum is
  /// wrong.
  static std::optional<EditRecord> record_in(const sql::Statement& row);

  /// Returns a statement for read_one(). It may be used for many records.
  StoreResult<sql::Statement> reader();
  /// Returns record `seq`, verified as in read().
  StoreResult<EditRecord> read_one(sql::Statement& reader, Sequence seq);

 private:
  LogTable(sql::Database& database, sql::Statement first, sql::Statement last,
           sql::Statement insert, sql::Statement insert_many)
      : database_(&database),
        first_(std::move(first)),
        last_(std::move(last)),
        insert_(std::move(insert)),
        insert_many_(std::move(insert_many)) {}
  Unexpected<StoreError> corrupt(Sequence seq, std::string what) const;

  sql::Database* database_;
  sql::Statement first_, last_, insert_;
  sql::Statement insert_many_;  // kManyRows; empty for SQLite
};

}  // namespace runstone
