#include "server/admin/server_health.hpp"

#include <array>
#include <utility>

#include "common/core/version.hpp"
#include "server/admin/amount_text.hpp"

namespace runstone {

std::string read_only_reason(const Order& order) {
  if (has_failed(order.ownership().state()))
    return "the log cannot be written any more, so the server must be started again";
  if (order.is_stopping()) return "the server stops";
  return order.is_disk_full() ? order.disk_reason() : "";
}

std::string uptime_text(TimeUs duration_us) {
  constexpr std::array<std::pair<TimeUs, const char*>, 4> kUnits = {
      {{86'400, "d"}, {3'600, "h"}, {60, "min"}, {1, "s"}}};
  TimeUs seconds = duration_us / 1'000'000;
  std::string text;
  int parts = 0;
  for (const auto& [length, unit] : kUnits) {
    const bool is_last = length == 1 && text.empty();
    if (parts == 2 || (seconds < length && !is_last)) continue;
    text += (text.empty() ? "" : " ") + std::to_string(seconds / length) + " " + unit;
    seconds %= length;
    ++parts;
  }
  return text;
}

std::string version_line(const ServerHealth& health) {
  return "runstone " + std::string(version()) + ", up " + uptime_text(health.uptime_us);
}

std::string disk_line(const ServerHealth& health) {
  std::string text;
  const auto add = [&](const char* before, const std::optional<std::uint64_t>& bytes,
                       const char* behind) {
    if (bytes) text += (text.empty() ? "" : ", ") + (before + byte_count_text(*bytes)) + behind;
  };
  add("", health.disk_free_bytes, " free");
  add("world ", health.world_bytes, "");
  add("its log of edits ", health.log_bytes, "");
  add("its write-ahead log ", health.wal_bytes, "");
  if (!text.empty()) text += ", ";
  return "disk: " + text + "oldest edit that is not on disk " +
         (health.durable_lag_us == 0 ? "none"
                                     : std::to_string(health.durable_lag_us / 1'000) + " ms old");
}

}  // namespace runstone
