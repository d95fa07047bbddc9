// find_action(): finds an action of a player in the log by the operation of its first edit. It
// blocks on the disk.
#pragma once
#include "server/store/log_reader.hpp"
#include "server/world/environment/world_environment.hpp"

namespace runstone {

/// Returns what the log has of the action that begins with this operation; `first` is 0 if it has
/// no such edit. The first edit is verified. Fails as the reader. Cost: O(records of the author
/// since that edit): few for an action under way, because its newest edit names its first one.
StoreResult<FoundAction> find_action(LogReader& reader, const OperationId& first_op);

}  // namespace runstone
