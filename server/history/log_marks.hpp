// Log marks: who edited when, for the timeline of a client.
#pragma once
#include "protocol/codec/log_mark_messages.hpp"
#include "server/store/log_reader.hpp"
#include "server/world/environment/world_environment.hpp"

namespace runstone {

/// Reads `count` records, evenly spaced from `first` to `last`, as far as the log has them: fewer
/// if there are fewer. Fails as LogReader::read_log(). Cost: O(count log records), because each
/// record is found by its key.
StoreResult<FoundLogMarks> read_log_marks(LogReader& reader, const LogMarksRequest& request);

}  // namespace runstone
