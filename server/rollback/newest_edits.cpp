#include "server/rollback/newest_edits.hpp"

#include <algorithm>
#include <deque>
#include <set>

namespace runstone {

StoreResult<std::vector<EditRecord>> newest_edits(LogReader& reader, const SelectionFilter& filter,
                                                  std::size_t count_max) {
  const auto range = reader.log_range();
  if (!range) return failure(range.error());
  const std::set<AuthorId> authors(filter.authors.begin(), filter.authors.end());
  std::deque<EditRecord> found;
  Sequence last = std::min(filter.last, range->last.version.seq);
  const Sequence first = std::max(filter.first, range->first);
  for (Sequence width = 4096; last >= first && found.size() < count_max; width *= 2) {
    LogQuery query;
    if (authors.size() == 1) query.author = *authors.begin();
    query.from_us = filter.from_us;
    query.until_us = filter.until_us;
    query.box = filter.box;
    query.cause = filter.cause;
    query.last = last;
    query.first = last - first >= width ? last - width + 1 : first;
    std::deque<EditRecord> window;
    const auto read = reader.query_log(query, [&](const EditRecord& record) {
      if (!authors.empty() && !authors.contains(record.op.author)) return true;
      window.push_back(record);
      if (window.size() + found.size() > count_max) window.pop_front();
      return true;
    });
    if (!read) return failure(read.error());
    found.insert(found.begin(), window.begin(), window.end());
    last = query.first - 1;
  }
  return std::vector<EditRecord>(found.begin(), found.end());
}

}  // namespace runstone
