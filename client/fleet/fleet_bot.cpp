#include "client/fleet/fleet_bot.hpp"

#include <utility>

#include "client/bots/headless_bot.hpp"
#include "client/bots/replica_bot.hpp"
#include "client/fleet/connected_bot.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

void add_session(FleetReport& report, const ReplicaBot& bot) {
  const PlacedVoxels::Standing standing = bot.standing();
  report.standing.held += standing.held;
  report.standing.intact += standing.intact;
  report.standing.changed += standing.changed;
  report.standing.unseen += standing.unseen;
  report.digests_checked += bot.session().replica().counters().digests_checked;
  report.drifted += bot.session().replica().counters().drifted;
}

void add_session(FleetReport& report, const HeadlessBot& bot) {
  const HeadlessSession& session = bot.session();
  report.commits += session.counts().commits;
  report.commit_edits += session.counts().edits;
  report.versions.merge(session.versions().counts());
  report.violations.merge(session.versions().violations());
}

template <class BotType>
class ConnectedFleetBot final : public FleetBot {
 public:
  template <class... BotArguments>
  ConnectedFleetBot(asio::io_context& io, const LinkConfig& net, BotArguments&&... arguments)
      : bot_(io, net, std::forward<BotArguments>(arguments)...) {}

  Bot& bot() override { return bot_.bot(); }
  const LinkStats& stats() const override { return bot_.link().stats(); }
  bool is_final() const override { return bot_.link().is_final(); }
  std::string failure(const std::string& what) const override { return bot_.failure(what); }
  void step(TimeUs now_us) override { bot_.step(now_us); }
  void leave(std::int64_t milliseconds) override { bot_.leave(milliseconds); }
  void add_to(FleetReport& report) const override {
    const BotType& bot = bot_.bot();
    report.counts.merge(bot.counts());
    report.bytes_received += stats().bytes_received.load();
    report.bytes_sent += stats().bytes_sent.load();
    report.traffic.add({stats().received.read(), stats().sent.read()});
    for (const auto& [reason, count] : bot_.link().losses()) report.losses[reason] += count;
    add_session(report, bot);
  }

 private:
  ConnectedBot<BotType> bot_;
};

}  // namespace

std::unique_ptr<FleetBot> make_fleet_bot(asio::io_context& io, const LinkConfig& net,
                                         const BotConfig& config, FleetStatistics& statistics,
                                         bool has_replica) {
  if (has_replica)
    return std::make_unique<ConnectedFleetBot<ReplicaBot>>(io, net, config, statistics);
  return std::make_unique<ConnectedFleetBot<HeadlessBot>>(io, net, config, statistics,
                                                          steady_now_us);
}

}  // namespace runstone
