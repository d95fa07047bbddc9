// newest_edits: the last edits of the log that answer a filter. Blocks on the disk.
#pragma once
#include <vector>

#include "server/rollback/selection.hpp"

namespace runstone {

/// The newest `count_max` edits, ascending. The log is asked in windows from its end, each twice as wide as the one
/// before, so that a question with many answers reads few of them.
StoreResult<std::vector<EditRecord>> newest_edits(LogReader& reader, const SelectionFilter& filter,
                                                  std::size_t count_max);

}  // namespace runstone
