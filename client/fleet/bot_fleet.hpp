// BotFleet: all bots of runstone-bot, each with its link, on one thread. The fleet joins, a bot after the other, waits until every bot
// sees what is around it, lets edits fall due, waits until everything is on disk, and leaves.
#pragma once
#include <csignal>
#include <memory>

#include "client/fleet/bot_options.hpp"
#include "client/fleet/fleet_report.hpp"

namespace runstone {

class BotFleet {
 public:
  /// Throws std::runtime_error on a key file that cannot be read.
  explicit BotFleet(const BotOptions& options);
  ~BotFleet();

  /// Plays to the end. `stop` counts signals: the first one ends the edits, and what was handed in is still waited for; the
  /// second one ends that too.
  FleetReport run(const volatile std::sig_atomic_t& stop);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace runstone
