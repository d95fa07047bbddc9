// PlayFleet: plays a recorded log on a live server, with one bot for each author of the log, all on
// one thread. The fleet joins, compares the materials, submits each edit at its time, waits until
// every edit was answered and is on disk, and leaves.
#pragma once
#include <csignal>
#include <memory>

#include "client/fleet/bot_options.hpp"
#include "client/fleet/play_report.hpp"

namespace runstone {

class PlayFleet {
 public:
  /// `log` must outlive the fleet.
  PlayFleet(const BotOptions& options, const RecordedLog& log);
  ~PlayFleet();

  /// Plays to the end, until a signal sets `stop`, or until there is no progress for the option
  /// --patience.
  PlayReport run(const volatile std::sig_atomic_t& stop);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace runstone
