#include "client/fleet/behaviour_fleet.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "client/fleet/fleet_bot.hpp"
#include "client/fleet/linked_session.hpp"
#include "client/fleet/step_scheduler.hpp"
#include "client/net/key_file.hpp"
#include "common/core/hash.hpp"
#include "common/os/open_files.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

constexpr TimeUs kCheckUs = 10'000;      // between two checks whether all bots are done
constexpr std::size_t kOtherFiles = 64;  // in addition to a socket for each bot

BotConfig config_of(const BotOptions& options, std::size_t index) {
  BotConfig config;
  config.session.name =
      options.count == 1 ? options.name : options.name + "-" + std::to_string(index + 1);
  config.session.keys =
      options.key_dir.empty()
          ? random_key()
          : load_or_create_key(
                (std::filesystem::path(options.key_dir) / (config.session.name + ".key")).string());
  if (!options.key_dir.empty()) config.session.features |= kFeatureNames;
  config.session.instance = random_instance();
  config.session.view.radius_h = options.view_radius;
  config.session.view.radius_v = options.view_radius_v;
  config.session.view.levels = options.far_levels;
  config.role = options.roles[index % options.roles.size()];
  config.site = (options.first_site + index) % options.sites;
  config.sites = options.sites;
  config.seed = mix64(options.seed + index);
  config.rate = options.rate;
  config.phase = static_cast<double>(index) / static_cast<double>(options.count);
  config.edits_max = options.edits;
  return config;
}

}  // namespace

struct BehaviourFleet::Parts {
  explicit Parts(const BotOptions& fleet_options) : options(fleet_options) {
    net.host = options.server.host;
    net.port = options.server.port;
    net.more = options.more_servers;
    net.tls = options.tls;
    net.web_path = options.web_path;
    if (!options.password.empty()) password = std::make_shared<PasswordKeys>(options.password);
    // All keys are read or drawn before the first bot connects, so that a missing file fails at the
    // start.
    for (std::size_t i = 0; i < options.count; ++i) {
      configs.push_back(config_of(options, i));
      configs.back().session.password = password;
    }
  }

  void join(TimeUs now_us) {
    const std::size_t index = bots.size();
    LinkConfig link = net;
    const BotConfig& config = configs[index];
    if (config.role == BotRole::join_storm) link.pause_ms_first = 1;  // it reconnects at once
    bots.push_back(make_fleet_bot(io, link, config, statistics, index < options.replicas));
    bots.back()->bot().start(now_us);
    scheduler.add(index, now_us);
  }
  /// Returns when the next bot joins, or nullopt if all have joined.
  std::optional<TimeUs> join_us() const {
    if (bots.size() == options.count) return std::nullopt;
    return began_us +
           static_cast<TimeUs>(static_cast<double>(bots.size()) / options.join_rate * 1e6);
  }

  /// Steps the bots that are due.
  void step(TimeUs now_us) {
    while (const auto step = scheduler.take(now_us)) {
      FleetBot& bot = *bots[step->bot];
      // The clock is read again because the steps before took time.
      const TimeUs at_us = steady_now_us();
      lag_us.add(at_us - step->due_us);
      bot.step(at_us);
      scheduler.add(step->bot, std::max(bot.bot().due_us(at_us), at_us + 1));
    }
  }

  /// Runs the links until that time.
  void run_links(TimeUs until_us) {
    bool is_time = false;
    timer.expires_at(std::chrono::steady_clock::time_point(std::chrono::microseconds(until_us)));
    timer.async_wait([&is_time](const std::error_code&) { is_time = true; });
    while (!is_time) io.run_one();
  }

  /// Runs the links and steps every bot when it is due. Returns true once all bots have joined and
  /// `done` holds. Returns false after `seconds`, or once `stop` reaches `signals`.
  bool play_until(const std::function<bool()>& done, double seconds,
                  const volatile std::sig_atomic_t& stop, int signals = 1) {
    const TimeUs end_us = steady_now_us() + static_cast<TimeUs>(seconds * 1e6);
    TimeUs check_us = 0;
    while (stop < signals) {
      const TimeUs now_us = steady_now_us();
      for (auto due = join_us(); due && *due <= now_us; due = join_us()) join(now_us);
      step(now_us);
      if (now_us >= check_us) {
        if (bots.size() == options.count && done()) return true;
        check_us = now_us + kCheckUs;
      }
      if (now_us >= end_us) return false;
      TimeUs until_us = std::min(check_us, end_us);
      if (const auto due = join_us()) until_us = std::min(until_us, *due);
      if (const auto due = scheduler.next_us()) until_us = std::min(until_us, *due);
      run_links(until_us);
    }
    return false;
  }
  template <class F>
  bool all(F&& holds) const {
    return std::all_of(bots.begin(), bots.end(), [&](const auto& bot) { return holds(*bot); });
  }
  /// Returns FleetBot::failure(what) of the first bot for which `holds` is false, or an empty text.
  std::string explain(const std::string& what, const std::function<bool(FleetBot&)>& holds) const {
    for (const auto& bot : bots) {
      if (!holds(*bot)) return bot->failure(what);
    }
    return {};
  }

  /// Bytes received and processor time used since the start.
  struct Meter {
    std::array<std::uint64_t, kFrameClassCount> class_bytes{};
    std::uint64_t frame_bytes = 0;
    ProcessTime process;
  };
  Meter meter() const {
    Meter now;
    now.process = process_time();
    for (const auto& bot : bots) {
      const LinkStats& net_stats = bot->stats();
      now.frame_bytes += net_stats.bytes_received.load();
      const Traffic received = net_stats.received.read();
      for (std::size_t i = 0; i < now.class_bytes.size(); ++i) {
        now.class_bytes[i] += of_class(received, static_cast<FrameClass>(i)).bytes;
      }
    }
    return now;
  }

  /// Plays until all edits were made or the duration is over, and adds the measurements to the
  /// report. Then waits until every edit was answered, is on disk, and has arrived at every bot that
  /// sees its place.
  void play(FleetReport& report, const volatile std::sig_atomic_t& stop);
  /// Blocks for two seconds at most.
  void leave() {
    for (const auto& bot : bots) bot->leave(kGoodbyeMs);
    io.restart();
    io.run_for(std::chrono::milliseconds(2 * kGoodbyeMs));
  }

  const BotOptions options;
  LinkConfig net;
  std::shared_ptr<PasswordKeys> password;  // null: none
  std::vector<BotConfig> configs;
  asio::io_context io{1};
  asio::steady_timer timer{io};
  FleetStatistics statistics;
  std::vector<std::unique_ptr<FleetBot>> bots;
  StepScheduler scheduler;
  Histogram lag_us;
  TimeUs began_us = 0;  // when the first bot joined
};

void BehaviourFleet::Parts::play(FleetReport& report, const volatile std::sig_atomic_t& stop) {
  const auto is_done = [](FleetBot& bot) { return bot.bot().is_done(); };
  const Meter before = meter();
  lag_us = {};
  const TimeUs start_us = steady_now_us();
  statistics.begin(start_us);
  for (const auto& bot : bots) bot->bot().begin(start_us);
  // The bots' next steps were scheduled for pings, which come after their first edits are due.
  scheduler.bring_forward(start_us);
  // Ends early when no bot has an edit left to make.
  play_until([&] { return options.edits && all(is_done); }, options.seconds, stop);
  for (const auto& bot : bots) bot->bot().end();
  report.seconds = static_cast<double>(steady_now_us() - start_us) / 1e6;
  const Meter after = meter();
  report.process = after.process - before.process;
  report.frame_bytes = after.frame_bytes - before.frame_bytes;
  for (std::size_t i = 0; i < report.class_bytes.size(); ++i) {
    report.class_bytes[i] = after.class_bytes[i] - before.class_bytes[i];
  }
  report.lag_us = lag_us;
  if (!play_until([&] { return all(is_done); }, options.load_seconds, stop, 2)) {
    report.failure = explain("has edits without an answer", is_done);
    return;
  }
  // The author of the newest edit knows that it is on disk.
  Sequence newest = 0;
  for (const auto& bot : bots) newest = std::max(newest, bot->bot().durable());
  const auto has_all = [newest](FleetBot& bot) { return bot.bot().durable() >= newest; };
  if (!play_until([&] { return all(has_all); }, options.load_seconds, stop, 2))
    report.failure = explain("has not received every edit", has_all);
}

BehaviourFleet::BehaviourFleet(const BotOptions& options)
    : parts_(std::make_unique<Parts>(options)) {}
BehaviourFleet::~BehaviourFleet() = default;

FleetReport BehaviourFleet::run(const volatile std::sig_atomic_t& stop) {
  Parts& fleet = *parts_;
  FleetReport report;
  report.bots = fleet.options.count;
  report.replicas = std::min(fleet.options.replicas, fleet.options.count);
  const std::size_t files = fleet.options.count + kOtherFiles;
  if (const std::size_t allowed = allow_open_files(files); allowed < files) {
    spdlog::warn("{} bots need {} open files, and the hard limit is {}: see ulimit -Hn",
                 report.bots, files, allowed);
  }
  const auto is_loaded = [](FleetBot& bot) { return bot.bot().counts().joins != 0; };
  const auto is_refused = [](FleetBot& bot) { return bot.is_final(); };

  fleet.began_us = steady_now_us();
  const double joining = static_cast<double>(fleet.options.count) / fleet.options.join_rate;
  fleet.play_until([&] { return fleet.all(is_loaded) || fleet.all(is_refused); },
                   joining + fleet.options.load_seconds, stop);
  report.failure = fleet.explain("does not see the world around it", is_loaded);
  if (report.failure.empty() && fleet.bots.size() < report.bots)
    report.failure = "stopped while joining";
  if (report.failure.empty()) {
    spdlog::info("{} bots see the world", report.bots);
    fleet.play(report, stop);
  }

  for (const auto& bot : fleet.bots) bot->add_to(report);
  report.seen_us = fleet.statistics.seen_us();
  report.seen_worst_us = fleet.statistics.worst_us();
  report.unattributed = fleet.statistics.unattributed();
  fleet.leave();
  return report;
}

}  // namespace runstone
