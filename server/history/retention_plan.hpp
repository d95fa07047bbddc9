// RetentionPlan: the edits that a retention would remove from the log of a world. It is made before
// the retention acts.
//   - Retention removes the oldest part of the log as a whole. It cannot keep a record of this
//     part, because the numbers of the log have no gaps, and each chunk is its base and all edits
//     since.
//   - The days count back from the newest edit, or from the clock if that is earlier. So the newest
//     edit stays, whatever the clock says, and a world in which nobody builds keeps what it has.
// Planning blocks on the disk.
#pragma once
#include <cstdint>
#include <string>

#include "server/store/world_reader.hpp"

namespace runstone {

inline constexpr std::uint64_t kRetentionDaysMax = 36'500;

struct RetentionPlan {
  std::uint64_t days = 0;
  LogEnd head;    // the last edit that is already removed
  LogEnd cut;     // the last edit that would be removed; equal to the head if there is none
  LogEnd newest;  // the last edit of the log
  LogVolume volume;
  FreeSpace free;
  /// The reason why a person must confirm the plan, as a sentence without a period. Empty: no
  /// confirmation is needed.
  std::string doubt;

  bool removes_nothing() const { return cut == head; }
};

/// Plans a retention that keeps the edits of so many days. `now_us`: UTC. Fails (bad_request) if
/// `days` is 0 or more than kRetentionDaysMax. The cut does not divide an action of a player whose
/// edits lie close together.
StoreResult<RetentionPlan> plan_retention(WorldReader& reader, std::uint64_t days, TimeUs now_us);

}  // namespace runstone
