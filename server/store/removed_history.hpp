// The words for edits that the log no longer has, because retention or a compaction has moved them
// into the base. Such edits are neither damage nor a gap.
#pragma once
#include <string>

#include "common/core/utc_text.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

/// Returns text such as "seq=100 (2023-11-14T22:13:20Z)" for the last edit that was removed.
inline std::string removed_place(const LogEnd& head) {
  return "seq=" + std::to_string(head.version.seq) + " (" + utc_text(head.time_us) + ")";
}

/// Returns a part of a sentence, such as "removed by retention up to seq=100
/// (2023-11-14T22:13:20Z)". `head` is LogReader::log_head() of a log from which edits were removed.
inline std::string removed_up_to(const LogEnd& head) {
  return "removed by retention up to " + removed_place(head);
}

}  // namespace runstone
