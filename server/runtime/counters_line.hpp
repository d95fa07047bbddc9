// The log line that shows the load of a server: "counters sessions=3 opened=7 …".
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "server/admin/backup_state.hpp"
#include "server/admin/retention_state.hpp"
#include "server/admin/server_health.hpp"
#include "server/net/net_session.hpp"
#include "server/store/log_writer.hpp"
#include "server/world/order/wait_histogram.hpp"
#include "server/world/world_server.hpp"

namespace runstone {

/// The counters that no part below has.
struct RuntimeCounters {
  std::uint64_t snapshots_encoded = 0;
  std::int64_t commit_enqueue_us = 0;  // processor time that queueing commits took
  std::uint64_t memory_bytes = 0;      // of the process
  std::uint64_t log_lines_dropped = 0;
  std::uint64_t row_faults = 0;                       // that the check of the rows has found
  std::optional<BackupState> backups = std::nullopt;  // that the server makes by itself
  RetentionState retention = {};
  ServerHealth health = {};
  WaitHistogram durable_waits = {};  // from ordering an edit until it was on disk
};

/// Returns one line of fields. Thread: the world strand.
std::string counters_line(const WorldServer& world, const NetCounters& net,
                          const LogWriter::Counters& log, const RuntimeCounters& runtime);

}  // namespace runstone
