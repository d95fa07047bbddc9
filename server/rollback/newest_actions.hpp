// newest_actions: the last actions of the log that match a filter, for lists of one line each. It
// blocks on the disk.
#pragma once
#include <cstdint>
#include <vector>

#include "server/rollback/selection.hpp"

namespace runstone {

/// An action of a player, an undo or redo of one, or any other record by itself.
struct LogAction {
  EditRecord newest;        // of its records that match
  Sequence first = 0;       // the oldest of its records that were read
  std::uint64_t edits = 0;  // its records that were read
  VoxelBox box;             // around them
};

/// Records that one call reads at most. Older ones count as if the log did not have them.
inline constexpr std::size_t kActionRecordsMax = 262'144;

/// Returns the newest `count_max` actions that match, ascending by their newest records. It reads
/// the log as read_log_backwards() does.
StoreResult<std::vector<LogAction>> newest_actions(LogReader& reader, const SelectionFilter& filter,
                                                   std::size_t count_max);

}  // namespace runstone
