// PlayReport: the result of playing a recorded log on a live server.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "client/bots/play_bot.hpp"
#include "client/report/traffic_report.hpp"

namespace runstone {

/// Sums over all authors of the log.
struct PlayReport {
  std::size_t bots = 0;
  std::uint64_t edits = 0;  // in the log
  PlayCounts counts;
  FleetTraffic traffic;
  double seconds = 0;    // from the first due edit until the last was answered and on disk
  bool started = false;  // all bots joined a world that knows the materials
  std::string failure;   // why the play did not start or ended early, or empty
  /// Returns true if every edit was confirmed and is on disk.
  bool is_complete() const {
    return started && failure.empty() && counts.confirmed == edits && counts.durable == edits;
  }
};

/// Adds the counts of one bot.
void add_to(PlayCounts& sum, const PlayCounts& one);
std::uint64_t sum_of(const std::map<std::string, std::uint64_t>& by_reason);

std::string to_json(const PlayReport& report);
/// Returns a few lines for standard output.
std::string to_table(const PlayReport& report);

}  // namespace runstone
