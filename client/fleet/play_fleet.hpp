// PlayFleet: a recorded log, played on a live server: one bot for each of its authors, all on one thread. The fleet
// joins, compares the materials, hands in each edit at its time, waits until everything was answered and is on disk,
// and leaves.
#pragma once
#include <csignal>
#include <memory>
#include <string>

#include "client/bots/play_bot.hpp"
#include "client/fleet/bot_options.hpp"
#include "client/report/traffic_report.hpp"

namespace runstone {

/// What became of the log, summed over its authors.
struct PlayReport {
  std::size_t bots = 0;
  std::uint64_t edits = 0;  // in the log
  PlayCounts counts;
  FleetTraffic traffic;
  double seconds = 0;    // from the first due edit until the last was answered and on disk
  bool started = false;  // all bots joined a world that knows the materials
  std::string failure;   // why it did not start, or ended early; empty: neither
  /// Every edit was confirmed and is on disk.
  bool is_complete() const {
    return started && failure.empty() && counts.confirmed == edits && counts.durable == edits;
  }
};
std::string to_json(const PlayReport& report);
/// A few lines for standard output.
std::string to_table(const PlayReport& report);

class PlayFleet {
 public:
  /// `log` must outlive the fleet.
  PlayFleet(const BotOptions& options, const RecordedLog& log);
  ~PlayFleet();

  /// Plays to the end, until `stop` is set by a signal, or until nothing moves for the options' patience.
  PlayReport run(const volatile std::sig_atomic_t& stop);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace runstone
