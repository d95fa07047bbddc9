// The records that changed rights. Reading blocks on the disk.
#pragma once
#include <vector>

#include "common/rights/change_rules.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

/// Returns all changes of rights that are on disk, ascending. They include those that a compaction
/// moved out of the log.
StoreResult<std::vector<RightsRecord>> read_rights_records(LogReader& reader);

}  // namespace runstone
