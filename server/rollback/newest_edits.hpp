// newest_edits: the last edits of the log that match a filter. It blocks on the disk.
#pragma once
#include <vector>

#include "server/rollback/selection.hpp"

namespace runstone {

/// Returns the newest `count_max` edits that match, ascending. The log is read in windows from its
/// end, each twice as wide as the one before. A filter that matches many edits therefore reads few
/// of them.
StoreResult<std::vector<EditRecord>> newest_edits(LogReader& reader, const SelectionFilter& filter,
                                                  std::size_t count_max);

}  // namespace runstone
