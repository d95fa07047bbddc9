// FleetBot: a bot of a crowd and its link, whichever kind of session it has.
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
  virtual const NetStats& stats() const = 0;
  /// To try again is pointless.
  virtual bool is_final() const = 0;
  /// "bot-3 was sent away: the server is full"
  virtual std::string failure(const std::string& what) const = 0;
  virtual void step(TimeUs now_us) = 0;
  virtual void leave(std::int64_t milliseconds) = 0;
  virtual void add_to(FleetReport& report) const = 0;
};

/// Also starts connecting. `io` and `crowd` must outlive the member.
std::unique_ptr<FleetBot> make_member(asio::io_context& io, const NetConfig& net,
                                      const BotConfig& config, FleetStatistics& fleet,
                                      bool has_replica);

}  // namespace runstone
