// LogSearch: finds the edits that match a LogQuery with the cheapest index:
//   - time by bisection of the log, since times never fall along it;
//   - place by the R*Tree of the segments;
//   - author and cause by their indexes.
// All calls must be in one read transaction.
// Threads: the one that owns the store.
#pragma once
#include <functional>
#include <vector>

#include "common/sql/database.hpp"
#include "server/store/log_reader.hpp"
#include "server/store/segment_table.hpp"

namespace runstone {

class LogSearch {
 public:
  LogSearch(sql::Database& database, SegmentTable& segments, const LogRange& range)
      : database_(database), segments_(segments), range_(range) {}

  /// Calls `each` with the sequences of all edits that match, ascending, until it returns false.
  StoreResult<void> run(const LogQuery& query, const std::function<bool(Sequence)>& each);
  /// Returns the first edit of first..last whose time is at least `time`, or last + 1 if there is
  /// none.
  StoreResult<Sequence> first_at(TimeUs time, Sequence first, Sequence last);

 private:
  StoreResult<TimeUs> time_of(Sequence seq);
  StoreResult<sql::Statement> matching(const LogQuery& query, std::optional<AuthorId> author) const;
  StoreResult<std::vector<Sequence>> in_segments(const LogQuery& query, Sequence first,
                                                 Sequence last);

  sql::Database& database_;
  SegmentTable& segments_;
  const LogRange range_;
  std::optional<sql::Statement> time_;
};

}  // namespace runstone
