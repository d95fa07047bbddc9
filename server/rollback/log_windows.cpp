#include "server/rollback/log_windows.hpp"

#include <algorithm>
#include <set>

namespace runstone {

StoreResult<void> read_log_backwards(LogReader& reader, const SelectionFilter& filter,
                                     const std::function<bool()>& wants_window,
                                     const std::function<void(const EditRecord&)>& to_record) {
  const auto range = reader.log_range();
  if (!range) return failure(range.error());
  const std::set<AuthorId> authors(filter.authors.begin(), filter.authors.end());
  Sequence last = std::min(filter.last, range->last.version.seq);
  const Sequence first = std::max(filter.first, range->first);
  for (Sequence width = 4096; last >= first && wants_window(); width *= 2) {
    LogQuery query;
    if (authors.size() == 1) query.author = *authors.begin();
    query.from_us = filter.from_us;
    query.until_us = filter.until_us;
    query.box = filter.box;
    query.cause = filter.cause;
    query.last = last;
    query.first = last - first >= width ? last - width + 1 : first;
    const auto read = reader.query_log(query, [&](const EditRecord& record) {
      const AuthorId author = record.op.author;
      const bool is_wanted = (authors.empty() || authors.contains(author)) &&
                             !std::ranges::binary_search(filter.excluded_authors, author);
      if (is_wanted) to_record(record);
      return true;
    });
    if (!read) return failure(read.error());
    last = query.first - 1;
  }
  return {};
}

}  // namespace runstone
