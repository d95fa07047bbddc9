// FleetReport: what a crowd of bots did and saw.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "client/bots/bot.hpp"
#include "client/bots/version_tracker.hpp"
#include "client/report/traffic_report.hpp"
#include "common/os/process_time.hpp"
#include "protocol/codec/frame.hpp"

namespace runstone {

/// Summed over its bots.
struct FleetReport {
  std::size_t bots = 0, replicas = 0;  // of the bots, those with a replica
  BotCounts counts;
  Histogram seen_us;  // due -> commit received and verified, each edit at each bot that got it
  std::vector<TimeUs> seen_worst_us;  // the slowest of the edits that were due in each second
  std::uint64_t unattributed = 0;     // edits received that no bot of the fleet made
  EditLedger::Standing standing;      // of the bots with a replica
  std::uint64_t audited = 0,
                drifted = 0;  // chunk digests compared with the server's, and found different
  // Of the bots without a replica.
  std::uint64_t commits = 0, commit_edits = 0;
  VersionCounts versions;
  Violations violations;
  std::map<std::string, std::uint64_t> losses;       // connections lost or not made, by reason
  std::uint64_t bytes_received = 0, bytes_sent = 0;  // all of the fleet's time
  FleetTraffic traffic;                              // likewise
  double seconds = 0;                                // from the first due edit to the last
  // Within these seconds.
  std::array<std::uint64_t, kFrameClassCount> class_bytes{};  // messages received, by class
  std::uint64_t frame_bytes = 0;  // the same with frame headers, all classes
  ProcessTime process;            // spent by this process
  Histogram lag_us;               // how late the bots' steps were
  std::string failure;            // why it ended early; empty: it did not

  /// Played to the end without a broken rule.
  bool is_sound() const { return failure.empty() && drifted == 0 && violations.total() == 0; }
};
std::string to_json(const FleetReport& report);
/// Some lines for standard output.
std::string to_table(const FleetReport& report);

}  // namespace runstone
