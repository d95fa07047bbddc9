// LogSearch: finds the edits that match a LogQuery with the cheapest index:
//   - time by bisection of one era of the log, within which times never fall;
//   - place by the R*Tree of the segments;
//   - author and cause by their indexes.
// It reads the records in the statements that find them, because a statement for each record costs
// as much as the search: with SQLite a descent of the tree, with PostgreSQL a round trip.
// All calls must be in one read transaction.
// Threads: the one that owns the store.
#pragma once
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "common/sql/database.hpp"
#include "server/store/log_reader.hpp"
#include "server/store/segment_table.hpp"

namespace runstone {

class LogSearch {
 public:
  /// `head` is the last edit that was compacted away. `eras` are those of MetaTable::log_eras().
  LogSearch(sql::Database& database, SegmentTable& segments, const LogEnd& head,
            const LogRange& range, std::vector<LogEra> eras)
      : database_(database),
        segments_(segments),
        head_(head),
        range_(range),
        eras_(std::move(eras)) {}

  /// Gets the sequence of an edit, and its record. The record is null if the search did not keep it
  /// because it is long, or if its row is damaged: LogTable::read_one() then reads it or names the
  /// damage. Returns false to end.
  using Each = std::function<bool(Sequence seq, const EditRecord* record)>;
  /// Calls `each` for all edits that match, ascending, until it returns false. Cost: O(edits found),
  /// and for a query with a box O(segments that meet it, edits of these segments). Memory: with a
  /// box, the segments, and short records of those that overlap in sequence.
  StoreResult<void> run(const LogQuery& query, const Each& each);
  /// Returns the newest edit whose time is not later than `time`, which may be the head. Returns
  /// nullopt if all of them are later.
  StoreResult<std::optional<Sequence>> newest_at(TimeUs time);

 private:
  /// Returns the first edit of first..last whose time is later than `time`, or last + 1 if there is
  /// none. Requires edits of one era.
  StoreResult<Sequence> first_behind(TimeUs time, Sequence first, Sequence last);
  StoreResult<TimeUs> time_of(Sequence seq);
  /// The index that a statement uses. PostgreSQL chooses by itself.
  enum class By { author, cause, sequence };
  /// Returns a statement for the records of a query. Its first two parameters are the first and the
  /// last sequence, the third is the author if there is one. Long descriptors may be missing.
  StoreResult<sql::Statement> matching(const LogQuery& query, std::optional<AuthorId> author,
                                       By by) const;
  StoreResult<void> run_in_box(const LogQuery& query, Sequence first, Sequence last,
                               const Each& each);

  sql::Database& database_;
  SegmentTable& segments_;
  const LogEnd head_;
  const LogRange range_;
  const std::vector<LogEra> eras_;
  std::optional<sql::Statement> time_;
};

}  // namespace runstone
