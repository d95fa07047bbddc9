// ServerHealth: what an operator looks at first: how long the server runs, what its disk holds, how
// far the disk is behind, and why edits are refused, if they are.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/ids.hpp"
#include "server/world/order/order.hpp"

namespace runstone {

/// Sizes that are not known are nullopt: those of a world in a database, and those that were not
/// measured yet.
struct ServerHealth {
  TimeUs uptime_us = 0;                          // since the start of the server
  std::optional<std::uint64_t> disk_free_bytes;  // that this user may still write
  std::optional<std::uint64_t> world_bytes;      // of the file world.sqlite
  std::optional<std::uint64_t> wal_bytes;        // of its write-ahead log
  std::optional<std::uint64_t> log_bytes;        // of the log of edits, as it was counted last
  TimeUs durable_lag_us = 0;  // since the oldest edit was ordered that is not on disk; 0: all are
};

/// Returns why this server refuses the edits of players, as a sentence without a period, or an empty
/// text if it takes them. A server that follows passes edits on, so it takes them.
std::string read_only_reason(const Order& order);

/// Returns a duration in its two largest units, as in "3 d 4 h". Times below a second are "0 s".
std::string uptime_text(TimeUs duration_us);

/// Returns "runstone VERSION, up 3 d 4 h".
std::string version_line(const ServerHealth& health);
/// Returns "disk: 12.3 GiB free, world 1.2 GiB, ...", without what is not known.
std::string disk_line(const ServerHealth& health);

}  // namespace runstone
