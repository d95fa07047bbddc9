// joined_after: which authors are new, as far as the log shows it. It blocks on the disk.
#pragma once
#include <vector>

#include "server/store/world_reader.hpp"

namespace runstone {

/// Returns the authors who joined after `time_us` (UTC), ascending. The store has no time of joining,
/// but author numbers ascend with it: if one author has an edit or a watermark from before, those with
/// smaller numbers had joined, too. So a player who joined before and built for the first time after it is
/// counted as new only if no later one had built by then. Fails as the reader. Cost: O(players +
/// watermarks), and O(log edits) for each author of the answer.
StoreResult<std::vector<AuthorId>> joined_after(WorldReader& reader, TimeUs time_us);

}  // namespace runstone
