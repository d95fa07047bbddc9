// StopState: what a server that has stopped leaves undone.
#pragma once
#include <cstddef>
#include <cstdint>

namespace runstone {

struct StopState {
  bool has_failed = false;       // the log, or a snapshot, could not be written
  std::uint64_t lost_edits = 0;  // ordered, but not in the log
  std::size_t chunks_left = 0;   // with edits in the log that no snapshot contains

  /// Returns true if every ordered edit is in the log.
  bool is_durable() const { return !has_failed && lost_edits == 0; }
  /// Returns true if every ordered edit is in the log and in snapshots.
  bool is_clean() const { return is_durable() && chunks_left == 0; }
};

}  // namespace runstone
