// LogSearch: answers a LogQuery by the cheapest way there is: time by halving the log (times never fall along
// it), place by the segments' R*Tree, author and cause by their indexes. Belongs to the thread that owns the
// store; call within one read transaction.
#pragma once
#include <functional>
#include <vector>

#include "common/sqlite/database.hpp"
#include "server/store/log_query.hpp"
#include "server/store/log_reader.hpp"
#include "server/store/segment_table.hpp"

namespace runstone {

class LogSearch {
 public:
  LogSearch(sql::Database& database, SegmentTable& segments, const LogRange& range)
      : database_(database), segments_(segments), range_(range) {}

  /// Calls `each` with the sequences of all edits that answer the query, ascending, until it returns false.
  StoreResult<void> run(const LogQuery& query, const std::function<bool(Sequence)>& each);
  /// The first edit of [first, last + 1] whose time is at least `time`; last + 1 if none is.
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
