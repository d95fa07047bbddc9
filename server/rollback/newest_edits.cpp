#include "server/rollback/newest_edits.hpp"

#include <deque>

#include "server/rollback/log_windows.hpp"

namespace runstone {

StoreResult<std::vector<EditRecord>> newest_edits(LogReader& reader, const SelectionFilter& filter,
                                                  std::size_t count_max) {
  std::deque<EditRecord> found, window;
  const auto join = [&] {
    found.insert(found.begin(), window.begin(), window.end());
    window.clear();
    return found.size() < count_max;
  };
  const auto read = read_log_backwards(reader, filter, join, [&](const EditRecord& record) {
    window.push_back(record);
    if (window.size() + found.size() > count_max) window.pop_front();
  });
  if (!read) return failure(read.error());
  join();
  return std::vector<EditRecord>(found.begin(), found.end());
}

}  // namespace runstone
