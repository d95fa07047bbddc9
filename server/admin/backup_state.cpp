#include "server/admin/backup_state.hpp"

#include "server/admin/amount_text.hpp"

namespace runstone {
namespace {

/// Returns a duration in the largest unit of which there is at least one.
std::string duration_text(std::uint64_t seconds) {
  if (seconds < 60) return std::to_string(seconds) + " s";
  if (seconds < 3600) return std::to_string(seconds / 60) + " min";
  if (seconds < 2 * 86'400ULL) return std::to_string(seconds / 3600) + " h";
  return std::to_string(seconds / 86'400) + " days";
}

}  // namespace

std::string backup_state_text(const BackupState& state) {
  std::string text = "backups: ";
  if (state.last) {
    const bool is_ahead = state.last->ahead_s > 0;
    text += "last " + state.last->name + ", " +
            (is_ahead ? "dated " + duration_text(state.last->ahead_s) + " in the future"
                      : duration_text(state.last->age_s) + " ago") +
            ", " + byte_count_text(state.last->bytes) + " (" +
            byte_count_text(state.last->new_bytes) + " new)";
  } else {
    text += "none yet";
  }
  text += state.is_under_way ? ", one is under way" : ", next in " + duration_text(state.next_s);
  if (state.last && state.last->ahead_s > 0) {
    text +=
        "\nBACKUPS: the last one is dated in the future: the clock of this computer was wrong, or "
        "is. It stays, and takes no place of another backup";
  }
  if (state.failures > 0) {
    text += "\nBACKUPS FAIL, " + std::to_string(state.failures) +
            (state.failures == 1 ? " time: " : " times: ") + state.failure;
  }
  return text;
}

std::string backup_counters(const BackupState& state) {
  std::string text;
  const auto add = [&](const char* name, std::uint64_t value) {
    text += (text.empty() ? "" : " ") + std::string(name) + "=" + std::to_string(value);
  };
  if (state.last) {
    add("backup_age_s", state.last->age_s);
    add("backup_bytes", state.last->bytes);
    add("backup_new_bytes", state.last->new_bytes);
  }
  add("backup_next_s", state.next_s);
  add("backup_failures", state.failures);
  return text;
}

}  // namespace runstone
