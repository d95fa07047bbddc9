// Everything that players and operators do at once: all threads of a server are busy while they
// share state. ThreadSanitizer finds the races.
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <future>
#include <string>

#include "client/fleet/behaviour_fleet.hpp"
#include "tests/integration/client/travel/live_session.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/integration/server/app/session_messages.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/replay/run_replay.hpp"

namespace runstone::test {
namespace {

constexpr std::uint32_t kBots = 24;

/// Rolls back what the first bot that has built anything has built so far: on a busy machine some bots
/// see the world only after all their edits were due. Returns the number of rollbacks, 0 or 1.
int roll_back_a_bot(const std::string& world) {
  const std::string begin = "preview ";
  for (std::uint32_t bot = 0; bot < kBots; ++bot) {
    const std::string text =
        control(world, {"rollback", "preview", "author", "bot-" + std::to_string(bot)}).text;
    if (!text.starts_with(begin)) continue;  // nothing to roll back
    const std::string id = text.substr(begin.size(), text.find(':') - begin.size());
    return control(world, {"rollback", "apply", id}).is_ok ? 1 : 0;
  }
  return 0;
}

FleetReport run_crowd(std::uint16_t port) {
  BotOptions options;
  options.server.port = port;
  options.count = options.sites = kBots;
  options.replicas = 6;
  options.roles = {BotRole::build, BotRole::grief, BotRole::brush, BotRole::run_away};
  options.rate = 20;
  options.edits = 60;
  options.seconds = 60;
  options.view_radius = options.view_radius_v = 2;
  const volatile std::sig_atomic_t never = 0;
  return BehaviourFleet(options).run(never);
}

}  // namespace

TEST_CASE("bots build while others undo, view the past and roll back", "[bots][crowd]") {
  const TempFolder folder;
  const std::string world = folder / "world";
  ServerConfig config = quiet_config(world);
  config.handshakes_per_address = 1'000;
  config.keyframe_edits = 50;
  auto server = start_server(config, flat_creation());
  auto fleet = std::async(std::launch::async, run_crowd, server->port());

  RawClient player(server->port());
  player.features = kFeatureCommands;
  REQUIRE(player.join(1).has_value());
  LiveSession viewer(server->port(), {1, {0, 0, 0}, 2, 1});
  viewer.catch_up();
  int undone = 0, redone = 0, rollbacks = 0;
  ClientSequence round = 0;
  do {
    ++round;
    player.send(voxel_edit(round, {1, 70, static_cast<std::int32_t>(round % 16)}, 1));
    undone += command(player, "undo").is_ok ? 1 : 0;  // the server limits commands per second
    redone += command(player, "redo").is_ok ? 1 : 0;
    viewer.travel({1, HistoryTarget::sequence, round, 0});
    CHECK(viewer.replica().past()->seq == round);
    viewer.travel({});
    if (round % 8 == 0) rollbacks += roll_back_a_bot(world);
  } while (fleet.wait_for(std::chrono::seconds(0)) != std::future_status::ready);

  const FleetReport report = fleet.get();
  INFO(to_table(report));
  CHECK(report.failure.empty());
  CHECK(report.is_sound());
  CHECK(report.counts.confirmed == report.counts.submitted);
  CHECK(undone > 0);
  CHECK(redone > 0);
  CHECK(rollbacks + roll_back_a_bot(world) > 0);
  viewer.catch_up();
  CHECK(viewer.replica().counters().drifted == 0);
  const StopReport stopped = server->stop();
  CHECK(stopped.is_clean);
  CHECK(stopped.error.empty());
  CHECK(run_replay({"verify", "--world", world}).code == 0);
}

}  // namespace runstone::test
