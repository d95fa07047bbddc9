// BotFleet: all bots of runstone-bot, each with its link, on one thread. The fleet joins, waits until every bot
// sees what is around it, lets edits fall due, waits until everything is on disk, and leaves.
#pragma once
#include <csignal>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "client/app/bot_options.hpp"
#include "client/bots/bot.hpp"

namespace runstone {

/// What the fleet did, summed over its bots.
struct FleetReport {
  std::size_t bots = 0;
  BotCounts counts;
  EditLedger::Standing standing;
  std::uint64_t audited = 0, drifted = 0;  // chunk digests compared with the server's, and found different
  std::uint64_t bytes_received = 0, bytes_sent = 0;
  double seconds = 0;   // from the first due edit to the last
  std::string failure;  // why it ended early; empty: it did not
};
std::string to_json(const FleetReport& report);
/// A few lines for standard output.
std::string to_table(const FleetReport& report);

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
