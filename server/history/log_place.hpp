// log_place: where in the log a moment is that people name by its time.
#pragma once
#include "server/store/store.hpp"

namespace runstone {

/// The last edit ordered at or before `utc_us`; the log's head, which may be (0, 0), if that lies before the first edit
/// kept. Times never fall along the log, so it is halved: O(log edits) rows read. Blocks on the disk.
StoreResult<LogEnd> last_edit_at(Store& reader, TimeUs utc_us);
/// The edit with this sequence, or the log's head for the head's own. Fails (bad_request) outside of the log, naming what
/// it holds.
StoreResult<LogEnd> edit_at(Store& reader, Sequence seq);

}  // namespace runstone
