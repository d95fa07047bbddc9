// FleetBot: a connected bot of a BehaviourFleet, with a replica or without one.
#pragma once
#include <asio/io_context.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "client/bots/bot.hpp"
#include "client/bots/fleet_statistics.hpp"
#include "client/fleet/fleet_report.hpp"
#include "client/net/link.hpp"

namespace runstone {

class FleetBot {
 public:
  virtual ~FleetBot() = default;
  virtual Bot& bot() = 0;
  virtual const LinkStats& stats() const = 0;
  /// Returns true if the server refused this bot for good.
  virtual bool is_final() const = 0;
  /// Returns a line such as "bot-3 does not see the world around it: the server is full".
  virtual std::string failure(const std::string& what) const = 0;
  virtual void step(TimeUs now_us) = 0;
  /// Sends a goodbye and ends the link after `milliseconds` of running the io_context at most.
  virtual void leave(std::int64_t milliseconds) = 0;
  virtual void add_to(FleetReport& report) const = 0;
};

/// Makes a bot, which starts connecting. `io` and `statistics` must outlive it.
std::unique_ptr<FleetBot> make_fleet_bot(asio::io_context& io, const LinkConfig& net,
                                         const BotConfig& config, FleetStatistics& statistics,
                                         bool has_replica);

}  // namespace runstone
