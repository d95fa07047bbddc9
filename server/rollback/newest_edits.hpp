// newest_edits: the last edits of the log that match a filter. It blocks on the disk.
#pragma once
#include <cstddef>
#include <vector>

#include "server/rollback/selection.hpp"

namespace runstone {

/// Returns the newest `count_max` edits that match, ascending. It reads the log as
/// read_log_backwards() does.
StoreResult<std::vector<EditRecord>> newest_edits(LogReader& reader, const SelectionFilter& filter,
                                                  std::size_t count_max);

}  // namespace runstone
