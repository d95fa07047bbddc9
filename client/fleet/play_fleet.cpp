#include "client/fleet/play_fleet.hpp"

#include <spdlog/spdlog.h>

#include <asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <utility>
#include <vector>

#include "client/fleet/connected_bot.hpp"
#include "client/net/key_file.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

using Player = ConnectedBot<PlayBot>;

constexpr std::chrono::milliseconds kStepEvery{5};  // how long bots go without a step

SessionConfig new_player() {
  SessionConfig config;
  config.keys = random_key();
  config.instance = random_instance();
  return config;
}

/// A count that grows with every progress of any bot.
std::uint64_t progress_of(const PlayBot& bot) {
  const PlayCounts& counts = bot.counts();
  return counts.confirmed + counts.durable + sum_of(counts.rejected) + counts.unseen +
         bot.session().connect_count();
}

}  // namespace

struct PlayFleet::Parts {
  Parts(const BotOptions& fleet_options, const RecordedLog& recorded)
      : options(fleet_options), log(recorded) {
    const LinkConfig net{.host = options.server.host,
                         .port = options.server.port,
                         .more = options.more_servers,
                         .tls = options.tls,
                         .web_path = options.web_path};
    for (const RecordedAuthor& author : log.authors)
      players.push_back(std::make_unique<Player>(io, net, author, new_player(), options.speed));
  }

  /// Runs the links and steps every bot until `done` holds for all of them, and returns an empty
  /// text. Otherwise returns why it stopped: a signal, a bot that the server refused, or no
  /// progress for as long as --patience while a bot waited.
  std::string play_until(const std::function<bool(Player&)>& done,
                         const volatile std::sig_atomic_t& stop) {
    const auto patience_us = static_cast<TimeUs>(options.load_seconds * 1e6);
    TimeUs progress_us = steady_now_us();
    std::uint64_t progress = 0;
    for (;;) {
      const TimeUs now_us = steady_now_us();
      std::uint64_t progress_now = 0;
      Player *open = nullptr, *waiting = nullptr;
      for (const auto& player : players) {
        player->step(now_us);
        progress_now += progress_of(player->bot());
        if (done(*player)) continue;
        if (player->link().is_final()) return player->failure("was refused");
        if (open == nullptr) open = player.get();
        if (waiting == nullptr && player->bot().waits()) waiting = player.get();
      }
      if (open == nullptr) return {};
      if (stop != 0) return "stopped";
      if (progress_now != std::exchange(progress, progress_now) || waiting == nullptr)
        progress_us = now_us;
      if (now_us - progress_us >= patience_us) {
        return waiting->failure(waiting->bot().session().is_open() ? "has edits without an answer"
                                                                   : "has no connection");
      }
      io.run_for(kStepEvery);
    }
  }

  /// Blocks for two seconds at most.
  void leave() {
    for (const auto& player : players) player->leave(kGoodbyeMs);
    io.run_for(std::chrono::milliseconds(2 * kGoodbyeMs));
  }

  const BotOptions options;
  const RecordedLog& log;
  asio::io_context io{1};
  std::vector<std::unique_ptr<Player>> players;
};

PlayFleet::PlayFleet(const BotOptions& options, const RecordedLog& log)
    : parts_(std::make_unique<Parts>(options, log)) {}
PlayFleet::~PlayFleet() = default;

PlayReport PlayFleet::run(const volatile std::sig_atomic_t& stop) {
  Parts& fleet = *parts_;
  PlayReport report;
  report.bots = fleet.players.size();
  report.edits = fleet.log.edits;
  report.failure =
      fleet.play_until([](Player& player) { return player.bot().session().is_open(); }, stop);
  if (report.failure.empty() && !fleet.players.empty()) {
    const auto known =
        check_materials(fleet.log, fleet.players.front()->bot().session().welcome()->materials);
    if (!known) report.failure = fleet.options.play + ": " + known.error();
  }
  if (report.failure.empty()) {
    report.started = true;
    spdlog::info("{} bots play {} edits", report.bots, report.edits);
    const TimeUs began_us = steady_now_us();
    for (const auto& player : fleet.players) player->bot().begin(began_us);
    report.failure = fleet.play_until([](Player& player) { return player.bot().is_done(); }, stop);
    report.seconds = static_cast<double>(steady_now_us() - began_us) / 1e6;
  }
  for (const auto& player : fleet.players) {
    add_to(report.counts, player->bot().counts());
    const LinkStats& stats = player->link().stats();
    report.traffic.add({stats.received.read(), stats.sent.read()});
  }
  fleet.leave();
  return report;
}

}  // namespace runstone
