// LogQuery: a question to the log: whose edits, when, where and why. What is left open asks for everything.
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
  std::optional<VoxelBox> box;  // edits whose bounding box has a voxel in common with it; not empty
  std::optional<Cause> cause;
  Sequence first = 1, last = kSequenceMax;  // both included
};

}  // namespace runstone
