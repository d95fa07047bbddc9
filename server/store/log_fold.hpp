// LogFold: the oldest part of the log, and the chunks after its edits. A store moves it into the
// base. Retention makes folds (server/history/fold_maker.hpp).
#pragma once
#include <utility>
#include <vector>

#include "common/core/ids.hpp"
#include "common/runs/chunk.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

struct LogFold {
  Sequence from = 0;  // the head of the log
  LogEnd to;          // the edit that becomes the head
  /// Each chunk that an edit of from + 1 .. to touches, as `to` left it, ascending by key.
  std::vector<std::pair<ChunkKey, ChunkPtr>> chunks;
};

/// The volume of a part of the log that a retention would remove. Its bytes are estimates.
struct LogVolume {
  std::uint64_t edits = 0;
  std::uint64_t log_bytes = 0;  // of records and their indexes
  std::uint64_t keyframes = 0;
  std::uint64_t keyframe_bytes = 0;
  std::uint64_t base_bytes_max = 0;  // the greatest growth of the base
  /// The number of edits for each cause but Cause::player, ascending.
  std::vector<std::pair<Cause, std::uint64_t>> causes;
};

/// The free space inside the file of a world. A world in PostgreSQL has no file.
struct FreeSpace {
  std::uint64_t bytes = 0;
  /// True if give_back_space() can return it to the disk. Otherwise only Store::shrink() can.
  bool can_be_given_back = false;
  bool is_in_file = false;  // false: the database keeps it for new rows
};

}  // namespace runstone
