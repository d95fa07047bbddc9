// BehaviourFleet: bots that each act by a behaviour, with their links, on one thread.
// A run has these parts:
//   1. the bots join, one after another, until each of them sees everything around it;
//   2. edits fall due;
//   3. the fleet waits until every edit was answered, is on disk, and has arrived at every bot that
//      sees its place;
//   4. all bots leave.
#pragma once
#include <csignal>
#include <memory>

#include "client/fleet/bot_options.hpp"
#include "client/fleet/fleet_report.hpp"

namespace runstone {

class BehaviourFleet {
 public:
  /// Throws std::runtime_error if a key file cannot be read.
  explicit BehaviourFleet(const BotOptions& options);
  ~BehaviourFleet();

  /// Runs all parts. `stop` counts signals. The first one ends part 2, the second one ends part 3.
  FleetReport run(const volatile std::sig_atomic_t& stop);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace runstone
