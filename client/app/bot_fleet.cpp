#include "client/app/bot_fleet.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "client/app/session_link.hpp"
#include "client/net/key_file.hpp"
#include "client/net/steady_clock.hpp"
#include "common/core/hash.hpp"

namespace runstone {
namespace {

constexpr auto kStepInterval = std::chrono::milliseconds(5);
constexpr std::int64_t kGoodbyeMs = 1'000;

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

/// A bot and its link.
class Member {
 public:
  Member(asio::io_context& io, BotConfig config, const NetConfig& net)
      : bot_(std::move(config)), link_(io, bot_.session(), bot_.config().session.name, net) {}

  Bot& bot() { return bot_; }
  const SessionLink& link() const { return link_; }

  void step(TimeUs now_us) {
    bot_.step(now_us);
    link_.flush();
  }
  void leave() { link_.leave(kGoodbyeMs); }

 private:
  Bot bot_;
  SessionLink link_;
};

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

struct BotFleet::Parts {
  explicit Parts(const BotOptions& fleet_options) : options(fleet_options) {
    const NetConfig net{.host = options.host, .port = options.port};
    for (std::size_t i = 0; i < options.count; ++i) {
      members.push_back(std::make_unique<Member>(io, config_of(options, i), net));
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
      io.run_for(kStepInterval);
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
      if (holds(*member)) continue;
      const std::string& why = member->link().last_failure();
      return member->bot().config().session.name + " " + what + (why.empty() ? "" : ": " + why);
    }
    return {};
  }

  const BotOptions options;
  asio::io_context io{1};
  std::vector<std::unique_ptr<Member>> members;
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
  for (const auto& member : fleet.members) member->leave();
  fleet.io.run_for(std::chrono::milliseconds(2 * kGoodbyeMs));
  return report;
}

std::string to_json(const FleetReport& report) {
  const BotCounts& c = report.counts;
  const auto percentile = [&c](double share) { return c.own_us.percentile(share).value_or(0); };
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
                                       {"own_us",
                                        {{"p50", percentile(0.5)},
                                         {"p90", percentile(0.9)},
                                         {"p99", percentile(0.99)},
                                         {"max", percentile(1)}}},
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
  const auto ms = [&c](double share) {
    return static_cast<double>(c.own_us.percentile(share).value_or(0)) / 1000;
  };
  return fmt::format(
      "bots {}: {} edits due in {:.1f} s, {} submitted, {} confirmed, {} rejected, {} durable; {} not ready, "
      "{} "
      "refused\n"
      "due to confirmed, ms: p50 {:.2f} p90 {:.2f} p99 {:.2f} max {:.2f}\n"
      "voxels set and not set again: {}, of them {} intact, {} changed, {} out of sight\n"
      "edits of others seen {}; drift: {} of {} chunk digests\n",
      report.bots, c.due, report.seconds, c.submitted, c.confirmed, c.rejected, c.durable, c.not_ready,
      c.refused, ms(0.5), ms(0.9), ms(0.99), ms(1), report.standing.held, report.standing.intact,
      report.standing.changed, report.standing.unseen, c.others, report.drifted, report.audited);
}

}  // namespace runstone
