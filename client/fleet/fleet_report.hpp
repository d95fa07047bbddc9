// FleetReport: the measurements of a BehaviourFleet.
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

/// Sums over all bots.
struct FleetReport {
  std::size_t bots = 0, replicas = 0;  // replicas: bots with a replica
  BotCounts counts;
  Histogram seen_us;  // due -> commit received and verified; each edit at each bot that received it
  std::vector<TimeUs> seen_worst_us;  // the slowest edit of those due in each second
  std::uint64_t unattributed = 0;     // edits received that no bot of the fleet made
  PlacedVoxels::Standing standing;    // of the bots with a replica
  // Counts of the bots with a replica: chunk digests that were compared with the server's, and
  // digests that differed.
  std::uint64_t digests_checked = 0, drifted = 0;
  // Counts of the bots without a replica.
  std::uint64_t commits = 0, commit_edits = 0;
  VersionCounts versions;
  Violations violations;
  std::map<std::string, std::uint64_t> losses;       // connections lost or not made, by reason
  std::uint64_t bytes_received = 0, bytes_sent = 0;  // from the first connection on
  FleetTraffic traffic;                              // from the first connection on
  double seconds = 0;                                // from the first due edit to the last
  // Within these seconds.
  std::array<std::uint64_t, kFrameClassCount> class_bytes{};  // messages received, by class
  std::uint64_t frame_bytes = 0;  // messages received with frame headers, all classes
  ProcessTime process;            // spent by this process
  Histogram lag_us;               // how late the bots' steps were
  std::string failure;            // why the run ended early, or empty

  /// Returns true if the run was complete, no replica drifted and the server broke no rule.
  bool is_sound() const { return failure.empty() && drifted == 0 && violations.total() == 0; }
};
std::string to_json(const FleetReport& report);
/// Returns some lines for standard output.
std::string to_table(const FleetReport& report);

}  // namespace runstone
