#include "client/app/bot_fleet.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "client/app/fleet.hpp"
#include "client/app/own_latency.hpp"
#include "client/net/key_file.hpp"
#include "client/net/steady_clock.hpp"
#include "common/core/hash.hpp"

namespace runstone {
namespace {

BotConfig config_of(const BotOptions& options, std::size_t index) {
  BotConfig config;
  config.session.name = options.count == 1 ? options.name : options.name + "-" + std::to_string(index + 1);
  config.session.keys =
      options.key_dir.empty()
          ? random_key()
          : load_or_create_key(
                (std::filesystem::path(options.key_dir) / (config.session.name + ".key")).string());
  config.session.instance = random_instance();
  config.session.view = {{}, options.view_radius, options.view_radius_v};
  config.role = options.role;
  config.site = index % options.sites;
  config.sites = options.sites;
  config.seed = mix64(options.seed + index);
  config.rate = options.rate;
  config.edits_max = options.edits;
  return config;
}

using Member = FleetMember<Bot>;

void add_up(BotCounts& sum, const BotCounts& one) {
  sum.due += one.due;
  sum.submitted += one.submitted;
  sum.not_ready += one.not_ready;
  sum.refused += one.refused;
  sum.confirmed += one.confirmed;
  sum.rejected += one.rejected;
  sum.durable += one.durable;
  sum.others += one.others;
  sum.own_us.merge(one.own_us);
}

}  // namespace

struct BotFleet::Parts : Fleet<Bot> {
  explicit Parts(const BotOptions& fleet_options) : options(fleet_options) {
    const NetConfig net{.host = options.host, .port = options.port};
    for (std::size_t i = 0; i < options.count; ++i) {
      add(net, config_of(options, i));
    }
  }

  /// Runs the links and steps every bot until `done`, the end of `seconds` (false) or so many signals (false).
  bool play_until(const std::function<bool()>& done, double seconds, const volatile std::sig_atomic_t& stop,
                  int signals = 1) {
    const TimeUs end_us = steady_now_us() + static_cast<TimeUs>(seconds * 1e6);
    while (stop < signals) {
      const TimeUs now_us = steady_now_us();
      for (const auto& member : members) member->step(now_us);
      if (done()) return true;
      if (now_us >= end_us) return false;
      run_links();
    }
    return false;
  }
  template <class F>
  bool all(F&& holds) const {
    return std::all_of(members.begin(), members.end(), [&](const auto& member) { return holds(*member); });
  }
  /// What is wrong with the first bot that is not as it should be.
  std::string explain(const std::string& what, const std::function<bool(Member&)>& holds) const {
    for (const auto& member : members) {
      if (!holds(*member)) return member->failure(what);
    }
    return {};
  }

  const BotOptions options;
};

BotFleet::BotFleet(const BotOptions& options) : parts_(std::make_unique<Parts>(options)) {}
BotFleet::~BotFleet() = default;

FleetReport BotFleet::run(const volatile std::sig_atomic_t& stop) {
  Parts& fleet = *parts_;
  const double patience = fleet.options.load_seconds;
  FleetReport report;
  report.bots = fleet.members.size();
  const auto is_loaded = [](Member& member) { return member.bot().loaded(); };
  const auto is_settled = [](Member& member) { return member.bot().settled(); };
  const auto is_refused = [](Member& member) { return member.link().is_final(); };

  fleet.play_until([&] { return fleet.all(is_loaded) || fleet.all(is_refused); }, patience, stop);
  report.failure = fleet.explain("does not see the world around it", is_loaded);
  if (report.failure.empty()) {
    spdlog::info("{} bots see the world", report.bots);
    const TimeUs began_us = steady_now_us();
    for (const auto& member : fleet.members) member->bot().begin(began_us);
    // Ends early when no bot has an edit left to make.
    fleet.play_until([&] { return fleet.options.edits && fleet.all(is_settled); }, fleet.options.seconds,
                     stop);
    for (const auto& member : fleet.members) member->bot().end();
    report.seconds = static_cast<double>(steady_now_us() - began_us) / 1e6;
    const bool settled = fleet.play_until([&] { return fleet.all(is_settled); }, patience, stop, 2);
    if (!settled) report.failure = fleet.explain("has edits without an answer", is_settled);
  }

  for (const auto& member : fleet.members) {
    const Bot& bot = member->bot();
    add_up(report.counts, bot.counts());
    const EditLedger::Standing standing = bot.standing();
    report.standing.held += standing.held;
    report.standing.intact += standing.intact;
    report.standing.changed += standing.changed;
    report.standing.unseen += standing.unseen;
    report.audited += bot.session().replica().counters().audited;
    report.drifted += bot.session().replica().counters().drifted;
    report.bytes_received += member->link().stats().bytes_received.load();
    report.bytes_sent += member->link().stats().bytes_sent.load();
  }
  fleet.leave();
  return report;
}

std::string to_json(const FleetReport& report) {
  const BotCounts& c = report.counts;
  const nlohmann::ordered_json json = {{"bots", report.bots},
                                       {"seconds", report.seconds},
                                       {"failure", report.failure},
                                       {"edits",
                                        {{"due", c.due},
                                         {"not_ready", c.not_ready},
                                         {"refused", c.refused},
                                         {"submitted", c.submitted},
                                         {"confirmed", c.confirmed},
                                         {"rejected", c.rejected},
                                         {"durable", c.durable},
                                         {"of_others", c.others}}},
                                       {"own_us", own_latency_json(c.own_us)},
                                       {"standing",
                                        {{"held", report.standing.held},
                                         {"intact", report.standing.intact},
                                         {"changed", report.standing.changed},
                                         {"unseen", report.standing.unseen}}},
                                       {"audited", report.audited},
                                       {"drifted", report.drifted},
                                       {"bytes_received", report.bytes_received},
                                       {"bytes_sent", report.bytes_sent}};
  return json.dump(1) + "\n";
}

std::string to_table(const FleetReport& report) {
  const BotCounts& c = report.counts;
  return fmt::format(
      "bots {}: {} edits due in {:.1f} s, {} submitted, {} confirmed, {} rejected, {} durable; {} not ready, "
      "{} refused\n"
      "{}"
      "voxels set and not set again: {}, of them {} intact, {} changed, {} out of sight\n"
      "edits of others seen {}; drift: {} of {} chunk digests\n",
      report.bots, c.due, report.seconds, c.submitted, c.confirmed, c.rejected, c.durable, c.not_ready,
      c.refused, own_latency_line(c.own_us), report.standing.held, report.standing.intact,
      report.standing.changed, report.standing.unseen, c.others, report.drifted, report.audited);
}

}  // namespace runstone
