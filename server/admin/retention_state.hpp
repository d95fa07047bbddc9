// RetentionState: the progress of the retention of a running server, for `retention`, `status` and
// the counters.
#pragma once
#include <cstdint>
#include <string>

#include "server/store/log_reader.hpp"

namespace runstone {

struct RetentionState {
  std::uint64_t days = 0;  // of the policy; 0: all edits stay
  bool is_running = false;
  std::string waits_for;  // the reason why a run pauses, as a part of a sentence; empty: it goes on
  LogEnd head;            // of the log, as the last run left it
  Sequence cut = 0;       // up to which the run under way removes edits
  std::uint64_t runs = 0;  // that have ended since the start
  // Since the start: edits that were removed, the parts that removed them, and the time of the log
  // writer that these parts took.
  std::uint64_t edits = 0, parts = 0, writer_us = 0, writer_us_max = 0;
  std::uint64_t failures = 0;  // of runs since the last one that succeeded
  std::string failure;         // the reason why the last run ended early; empty: it did not
  std::string doubt;  // the reason why the policy waits for a confirmation; empty: it does not
};

/// Returns the lines of the command `retention`.
std::string retention_state_text(const RetentionState& state);
/// Returns the fields of the line of counters, such as "retention_edits=120 retention_parts=3 ...".
std::string retention_counters(const RetentionState& state);

}  // namespace runstone
