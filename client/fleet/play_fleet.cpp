#include "client/fleet/play_fleet.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "client/fleet/fleet.hpp"
#include "client/net/key_file.hpp"
#include "client/report/histogram_report.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

SessionConfig new_player() {
  SessionConfig config;
  config.keys = random_key();
  config.instance = random_instance();
  config.view = {{}, 0, 0};
  return config;
}

using Member = FleetMember<PlayBot>;

void add_up(PlayCounts& sum, const PlayCounts& one) {
  sum.due += one.due;
  sum.submitted += one.submitted;
  sum.retried += one.retried;
  sum.confirmed += one.confirmed;
  sum.durable += one.durable;
  sum.unseen += one.unseen;
  for (const auto& [reason, count] : one.rejected) sum.rejected[reason] += count;
  for (const auto& [reason, count] : one.refused) sum.refused[reason] += count;
  sum.confirm_us.merge(one.confirm_us);
}

std::uint64_t total(const std::map<std::string, std::uint64_t>& by_reason) {
  std::uint64_t sum = 0;
  for (const auto& [reason, count] : by_reason) sum += count;
  return sum;
}

}  // namespace

struct PlayFleet::Parts : Fleet<PlayBot> {
  Parts(const BotOptions& fleet_options, const RecordedLog& recorded)
      : options(fleet_options), log(recorded) {
    const NetConfig net{.host = options.host, .port = options.port};
    for (const RecordedAuthor& author : log.authors) {
      add(net, author, new_player(), options.speed);
    }
  }

  /// Runs the links and steps every bot until `done`. Otherwise what stood in the way: a stop, a server that does not
  /// want a bot, or nothing that moved for as long as patience lasts while a bot waited.
  std::string play_until(const std::function<bool(Member&)>& done,
                         const volatile std::sig_atomic_t& stop) {
    const auto patience_us = static_cast<TimeUs>(options.load_seconds * 1e6);
    TimeUs moved_us = steady_now_us();
    std::uint64_t moves = 0;
    for (;;) {
      const TimeUs now_us = steady_now_us();
      std::uint64_t moves_now = 0;
      Member *open = nullptr, *waiting = nullptr;
      for (const auto& member : members) {
        member->step(now_us);
        const PlayCounts& counts = member->bot().counts();
        moves_now += counts.confirmed + counts.durable + total(counts.rejected) + counts.unseen +
                     member->bot().session().connect_count();
        if (done(*member)) continue;
        if (member->link().is_final()) return member->failure("was sent away");
        if (open == nullptr) open = member.get();
        if (waiting == nullptr && member->bot().waits()) waiting = member.get();
      }
      if (open == nullptr) return {};
      if (stop != 0) return "stopped";
      if (moves_now != std::exchange(moves, moves_now) || waiting == nullptr) moved_us = now_us;
      if (now_us - moved_us >= patience_us) {
        return waiting->failure(waiting->bot().session().is_open() ? "has edits without an answer"
                                                                   : "has no connection");
      }
      run_links();
    }
  }

  const BotOptions options;
  const RecordedLog& log;
};

PlayFleet::PlayFleet(const BotOptions& options, const RecordedLog& log)
    : parts_(std::make_unique<Parts>(options, log)) {}
PlayFleet::~PlayFleet() = default;

PlayReport PlayFleet::run(const volatile std::sig_atomic_t& stop) {
  Parts& fleet = *parts_;
  PlayReport report;
  report.bots = fleet.members.size();
  report.edits = fleet.log.edits;
  report.failure =
      fleet.play_until([](Member& member) { return member.bot().session().is_open(); }, stop);
  if (report.failure.empty() && !fleet.members.empty()) {
    const auto known =
        check_materials(fleet.log, fleet.members.front()->bot().session().welcome()->materials);
    if (!known) report.failure = fleet.options.play + ": " + known.error();
  }
  if (report.failure.empty()) {
    report.started = true;
    spdlog::info("{} bots play {} edits", report.bots, report.edits);
    const TimeUs began_us = steady_now_us();
    for (const auto& member : fleet.members) member->bot().begin(began_us);
    report.failure = fleet.play_until([](Member& member) { return member.bot().is_done(); }, stop);
    report.seconds = static_cast<double>(steady_now_us() - began_us) / 1e6;
  }
  for (const auto& member : fleet.members) {
    add_up(report.counts, member->bot().counts());
    const NetStats& stats = member->link().stats();
    report.traffic.add({stats.received.read(), stats.sent.read()});
  }
  fleet.leave();
  return report;
}

std::string to_json(const PlayReport& report) {
  const PlayCounts& c = report.counts;
  const nlohmann::ordered_json json = {{"bots", report.bots},
                                       {"seconds", report.seconds},
                                       {"failure", report.failure},
                                       {"edits",
                                        {{"recorded", report.edits},
                                         {"due", c.due},
                                         {"submitted", c.submitted},
                                         {"again", c.retried},
                                         {"confirmed", c.confirmed},
                                         {"rejected", c.rejected},
                                         {"refused", c.refused},
                                         {"unseen", c.unseen},
                                         {"durable", c.durable}}},
                                       {"own_us", histogram_json(c.confirm_us)},
                                       {"traffic", traffic_json(report.traffic)}};
  return json.dump(1) + "\n";
}

std::string to_table(const PlayReport& report) {
  const PlayCounts& c = report.counts;
  std::string table = fmt::format(
      "bots {}: {} recorded edits, {} due in {:.1f} s, {} submitted, {} confirmed, {} durable; {} "
      "offered "
      "again, {} rejected, {} refused here, {} without an answer\n{}",
      report.bots, report.edits, c.due, report.seconds, c.submitted, c.confirmed, c.durable,
      c.retried, total(c.rejected), total(c.refused), c.unseen,
      histogram_line("due to confirmed", c.confirm_us));
  for (const auto& [reason, count] : c.rejected)
    table += fmt::format("rejected: {} {}\n", count, reason);
  for (const auto& [reason, count] : c.refused)
    table += fmt::format("refused: {} {}\n", count, reason);
  return table + traffic_table(report.traffic);
}

}  // namespace runstone
