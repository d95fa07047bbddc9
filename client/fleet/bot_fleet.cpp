#include "client/fleet/bot_fleet.hpp"

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
#include "client/fleet/step_scheduler.hpp"
#include "client/net/key_file.hpp"
#include "common/core/hash.hpp"
#include "common/os/open_files.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

constexpr TimeUs kCheckUs = 10'000;      // between two looks at whether all are done
constexpr std::size_t kOtherFiles = 64;  // besides a socket for each bot
constexpr std::int64_t kGoodbyeMs = 1'000;

BotConfig config_of(const BotOptions& options, std::size_t index) {
  BotConfig config;
  config.session.name =
      options.count == 1 ? options.name : options.name + "-" + std::to_string(index + 1);
  config.session.keys =
      options.key_dir.empty()
          ? random_key()
          : load_or_create_key(
                (std::filesystem::path(options.key_dir) / (config.session.name + ".key")).string());
  config.session.instance = random_instance();
  config.session.view = {{}, options.view_radius, options.view_radius_v};
  config.role = options.roles[index % options.roles.size()];
  config.site = index % options.sites;
  config.sites = options.sites;
  config.seed = mix64(options.seed + index);
  config.rate = options.rate;
  config.phase = static_cast<double>(index) / static_cast<double>(options.count);
  config.edits_max = options.edits;
  return config;
}

}  // namespace

struct BotFleet::Parts {
  explicit Parts(const BotOptions& fleet_options) : options(fleet_options) {
    net.host = options.host;
    net.port = options.port;
    // Keys are read or drawn before the first bot connects: a file that is missing is told at the start.
    for (std::size_t i = 0; i < options.count; ++i) configs.push_back(config_of(options, i));
  }

  void join(TimeUs now_us) {
    const std::size_t index = members.size();
    NetConfig link = net;
    const BotConfig& config = configs[index];
    if (config.role == BotRole::join_storm) link.pause_ms_first = 1;  // it comes back at once
    members.push_back(make_member(io, link, config, fleet, index < options.replicas));
    members.back()->bot().start(now_us);
    turns.add(index, now_us);
  }
  /// When the next bot joins; nothing if all have.
  std::optional<TimeUs> join_us() const {
    if (members.size() == options.count) return std::nullopt;
    return began_us +
           static_cast<TimeUs>(static_cast<double>(members.size()) / options.join_rate * 1e6);
  }

  void step(TimeUs now_us) {
    while (const auto turn = turns.take(now_us)) {
      FleetBot& member = *members[turn->who];
      // Read again: the steps before took their time.
      const TimeUs at_us = steady_now_us();
      lag_us.add(at_us - turn->due_us);
      member.step(at_us);
      turns.add(turn->who, std::max(member.bot().due_us(at_us), at_us + 1));
    }
  }

  /// Runs the links until then.
  void run_links(TimeUs until_us) {
    bool is_time = false;
    timer.expires_at(std::chrono::steady_clock::time_point(std::chrono::microseconds(until_us)));
    timer.async_wait([&is_time](const std::error_code&) { is_time = true; });
    while (!is_time) io.run_one();
  }

  /// Runs the links and steps every bot when it is due until `done`, the end of `seconds` (false) or so many signals (false).
  bool play_until(const std::function<bool()>& done, double seconds,
                  const volatile std::sig_atomic_t& stop, int signals = 1) {
    const TimeUs end_us = steady_now_us() + static_cast<TimeUs>(seconds * 1e6);
    TimeUs check_us = 0;
    while (stop < signals) {
      const TimeUs now_us = steady_now_us();
      for (auto due = join_us(); due && *due <= now_us; due = join_us()) join(now_us);
      step(now_us);
      if (now_us >= check_us) {
        if (members.size() == options.count && done()) return true;
        check_us = now_us + kCheckUs;
      }
      if (now_us >= end_us) return false;
      TimeUs until_us = std::min(check_us, end_us);
      if (const auto due = join_us()) until_us = std::min(until_us, *due);
      if (const auto due = turns.next_us()) until_us = std::min(until_us, *due);
      run_links(until_us);
    }
    return false;
  }
  template <class F>
  bool all(F&& holds) const {
    return std::all_of(members.begin(), members.end(),
                       [&](const auto& member) { return holds(*member); });
  }
  /// What is wrong with the first bot that is not as it should be.
  std::string explain(const std::string& what, const std::function<bool(FleetBot&)>& holds) const {
    for (const auto& member : members) {
      if (!holds(*member)) return member->failure(what);
    }
    return {};
  }

  /// Bytes received so far, and the processor's time.
  struct Meter {
    std::array<std::uint64_t, kFrameClassCount> class_bytes{};
    std::uint64_t frame_bytes = 0;
    ProcessTime process;
  };
  Meter meter() const {
    Meter now;
    now.process = process_time();
    for (const auto& member : members) {
      const NetStats& net_stats = member->stats();
      now.frame_bytes += net_stats.bytes_received.load();
      const Traffic received = net_stats.received.read();
      for (std::size_t i = 0; i < now.class_bytes.size(); ++i) {
        now.class_bytes[i] += of_class(received, static_cast<FrameClass>(i)).bytes;
      }
    }
    return now;
  }

  /// Blocks for two seconds at most.
  void leave() {
    for (const auto& member : members) member->leave(kGoodbyeMs);
    io.restart();
    io.run_for(std::chrono::milliseconds(2 * kGoodbyeMs));
  }

  const BotOptions options;
  NetConfig net;
  std::vector<BotConfig> configs;
  asio::io_context io{1};
  asio::steady_timer timer{io};
  FleetStatistics fleet;
  std::vector<std::unique_ptr<FleetBot>> members;
  StepScheduler turns;
  Histogram lag_us;
  TimeUs began_us = 0;  // when the first bot joined
};

BotFleet::BotFleet(const BotOptions& options) : parts_(std::make_unique<Parts>(options)) {}
BotFleet::~BotFleet() = default;

FleetReport BotFleet::run(const volatile std::sig_atomic_t& stop) {
  Parts& fleet = *parts_;
  const double patience = fleet.options.load_seconds;
  FleetReport report;
  report.bots = fleet.options.count;
  report.replicas = std::min(fleet.options.replicas, fleet.options.count);
  const std::size_t files = fleet.options.count + kOtherFiles;
  if (const std::size_t allowed = allow_open_files(files); allowed < files) {
    spdlog::warn("{} bots need {} open files, and the hard limit is {}: see ulimit -Hn",
                 report.bots, files, allowed);
  }
  const auto is_loaded = [](FleetBot& member) { return member.bot().counts().joins != 0; };
  const auto is_settled = [](FleetBot& member) { return member.bot().is_done(); };
  const auto is_refused = [](FleetBot& member) { return member.is_final(); };

  fleet.began_us = steady_now_us();
  const double joining = static_cast<double>(fleet.options.count) / fleet.options.join_rate;
  fleet.play_until([&] { return fleet.all(is_loaded) || fleet.all(is_refused); },
                   joining + patience, stop);
  report.failure = fleet.explain("does not see the world around it", is_loaded);
  if (report.failure.empty() && fleet.members.size() < report.bots)
    report.failure = "stopped while joining";
  if (report.failure.empty()) {
    spdlog::info("{} bots see the world", report.bots);
    const Parts::Meter before = fleet.meter();
    fleet.lag_us = {};
    const TimeUs began_us = steady_now_us();
    fleet.fleet.begin(began_us);
    for (const auto& member : fleet.members) member->bot().begin(began_us);
    fleet.turns.hasten(
        began_us);  // they were to ping next, some time after their first edits are due
    // Ends early when no bot has an edit left to make.
    fleet.play_until([&] { return fleet.options.edits && fleet.all(is_settled); },
                     fleet.options.seconds, stop);
    for (const auto& member : fleet.members) member->bot().end();
    report.seconds = static_cast<double>(steady_now_us() - began_us) / 1e6;
    const Parts::Meter after = fleet.meter();
    report.process = after.process - before.process;
    report.frame_bytes = after.frame_bytes - before.frame_bytes;
    for (std::size_t i = 0; i < report.class_bytes.size(); ++i) {
      report.class_bytes[i] = after.class_bytes[i] - before.class_bytes[i];
    }
    report.lag_us = fleet.lag_us;
    const bool settled = fleet.play_until([&] { return fleet.all(is_settled); }, patience, stop, 2);
    if (!settled) report.failure = fleet.explain("has edits without an answer", is_settled);
  }

  for (const auto& member : fleet.members) member->add_to(report);
  report.seen_us = fleet.fleet.seen_us();
  report.seen_worst_us = fleet.fleet.worst_us();
  report.unattributed = fleet.fleet.unattributed();
  fleet.leave();
  return report;
}

}  // namespace runstone
