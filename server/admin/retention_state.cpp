#include "server/admin/retention_state.hpp"

#include <algorithm>

#include "server/rollback/count_text.hpp"
#include "server/store/removed_history.hpp"

namespace runstone {

std::string retention_state_text(const RetentionState& state) {
  std::string text = state.days == 0
                         ? "retention: off, every edit stays in the log (retention_days = 0)"
                         : "retention: edits stay in the log for " + counted(state.days, "day");
  if (state.head.version.seq > 0)
    text += "\nhistory: " + removed_up_to(state.head) +
            "; time travel, rollback and undo reach back to there";
  if (state.is_running) {
    text +=
        "\nunder way: " + counted(state.cut - std::min(state.cut, state.head.version.seq), "edit") +
        " to go, up to seq=" + std::to_string(state.cut);
    if (!state.waits_for.empty()) text += "; it waits: " + state.waits_for;
  }
  text += "\nsince the start: " + counted(state.edits, "edit") + " removed in " +
          counted(state.parts, "part");
  if (state.parts > 0)
    text += ", of " + std::to_string(state.writer_us / state.parts / 1000) +
            " ms of the log writer (" + std::to_string(state.writer_us_max / 1000) + " ms at most)";
  if (!state.doubt.empty())
    text += "\nRETENTION WAITS: " + state.doubt +
            "; if that is right, `retention run DAYS anyway` removes the edits before it";
  if (!state.failure.empty())
    text += "\nRETENTION FAILS, " + counted(state.failures, "time") + ": " + state.failure;
  return text;
}

std::string retention_counters(const RetentionState& state) {
  std::string text = "retention_days=" + std::to_string(state.days);
  const auto add = [&](const char* name, std::uint64_t value) {
    text += std::string(" ") + name + "=" + std::to_string(value);
  };
  add("retention_running", state.is_running ? 1 : 0);
  add("retention_head", state.head.version.seq);
  add("retention_edits", state.edits);
  add("retention_parts", state.parts);
  add("retention_writer_us", state.writer_us);
  add("retention_writer_us_max", state.writer_us_max);
  add("retention_failures", state.failures);
  return text;
}

}  // namespace runstone
