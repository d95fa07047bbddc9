// LogSearch: finds the edits that match a LogQuery with the cheapest index:
//   - time by bisection of one era of the log, within which times never fall;
//   - place by the R*Tree of the segments;
//   - author and cause by their indexes.
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

  /// Calls `each` with the sequences of all edits that match, ascending, until it returns false.
  StoreResult<void> run(const LogQuery& query, const std::function<bool(Sequence)>& each);
  /// Returns the newest edit whose time is not later than `time`, which may be the head. Returns
  /// nullopt if all of them are later.
  StoreResult<std::optional<Sequence>> newest_at(TimeUs time);

 private:
  /// Returns the first edit of first..last whose time is later than `time`, or last + 1 if there is
  /// none. Requires edits of one era.
  StoreResult<Sequence> first_behind(TimeUs time, Sequence first, Sequence last);
  StoreResult<TimeUs> time_of(Sequence seq);
  StoreResult<sql::Statement> matching(const LogQuery& query, std::optional<AuthorId> author) const;
  StoreResult<std::vector<Sequence>> in_segments(const LogQuery& query, Sequence first,
                                                 Sequence last);

  sql::Database& database_;
  SegmentTable& segments_;
  const LogEnd head_;
  const LogRange range_;
  const std::vector<LogEra> eras_;
  std::optional<sql::Statement> time_;
};

}  // namespace runstone
