// LogQuery: conditions on edits of the log: author, time, place and cause. A condition that is not
// set holds for every edit.
#pragma once
#include <limits>
#include <optional>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

struct LogQuery {
  std::optional<AuthorId> author;
  TimeUs from_us = std::numeric_limits<TimeUs>::min();   // UTC, included
  TimeUs until_us = std::numeric_limits<TimeUs>::max();  // included
  std::optional<VoxelBox> box;  // not empty; overlaps the bounding box of the edit
  std::optional<Cause> cause;
  Sequence first = 1, last = kSequenceMax;  // both included
};

}  // namespace runstone
