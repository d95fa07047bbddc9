// Fleets of bots against a real server on loopback.
#include "client/fleet/behaviour_fleet.hpp"

#include <pthread.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <thread>

#include "tests/integration/server/app/server_bench.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

volatile std::sig_atomic_t never = 0;

/// A server of a flat world that accepts large fleets.
struct FlatServer {
  TempFolder folder;
  std::unique_ptr<Server> server = [&] {
    ServerConfig config = quiet_config(folder.path());
    config.handshakes_per_address = 1'000;
    return start_server(config, flat_creation());
  }();
};

BotOptions options_for(const Server& server, BotRole role, std::size_t count) {
  BotOptions options;
  options.server.port = server.port();
  options.count = options.sites = count;
  options.roles = {role};
  options.rate = 200;
  options.edits = 100;
  options.seconds = 60;
  options.view_radius = options.view_radius_v = 3;  // chunks of edge 16
  return options;
}

}  // namespace

TEST_CASE("builders submit all edits, and each is confirmed and stays in the world", "[bots]") {
  const FlatServer flat;
  const FleetReport report =
      BehaviourFleet(options_for(*flat.server, BotRole::build, 5)).run(never);
  INFO(report.failure);
  CHECK(report.failure.empty());
  CHECK(report.counts.due == 500);
  CHECK(report.counts.submitted == 500);
  CHECK(report.counts.confirmed == 500);
  CHECK(report.counts.durable == 500);
  CHECK(report.counts.rejected == 0);
  CHECK(report.traffic.sent[kKindOf<Ping>].messages >= 5);
  CHECK(of_class(report.traffic.sent, FrameClass::edits).messages == 500);
  for (const auto& [way, bytes] : {std::pair(report.traffic.received, report.bytes_received),
                                   std::pair(report.traffic.sent, report.bytes_sent)}) {
    std::uint64_t sum = 0;
    for (const KindTraffic& kind : way) sum += kind.bytes + kind.frames * kFrameHeaderBytes;
    CHECK(sum <= bytes + 64 * 1024);  // bytes that are not counted yet
    CHECK(bytes <= sum + 64 * 1024);  // a message in transit
  }
  CHECK(report.standing.held > 400);
  CHECK(report.standing.intact == report.standing.held);
  CHECK(report.drifted == 0);
  CHECK(flat.server->stop().digests.seq == 500);
}

TEST_CASE("edits due soon after the start are made on time, not with the next ping", "[bots]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder.path()), flat_creation());
  BotOptions options = options_for(*server, BotRole::build, 4);
  options.replicas = 0;   // a bot with a replica is stepped more often
  options.join_rate = 8;  // so that the first bots have nothing to do but ping
  options.rate = 4;
  options.seconds = 0.4;  // the first edits are due within a quarter of a second
  const FleetReport report = BehaviourFleet(options).run(never);
  CHECK(report.failure.empty());
  CHECK(report.counts.due >= 4);
}

TEST_CASE("bots with the behaviours brush and griefer edit, and those with idle and walk do not",
          "[bots]") {
  const FlatServer flat;
  for (const BotRole role : {BotRole::brush, BotRole::grief}) {
    const FleetReport report = BehaviourFleet(options_for(*flat.server, role, 2)).run(never);
    CHECK(report.failure.empty());
    CHECK(report.counts.confirmed > 50);
    CHECK(report.counts.confirmed == report.counts.submitted);
  }
  BotOptions options = options_for(*flat.server, BotRole::walk, 2);
  options.seconds = 0.3;
  const FleetReport report = BehaviourFleet(options).run(never);
  CHECK(report.failure.empty());
  CHECK(report.counts.submitted == 0);
  CHECK(report.counts.not_ready > 0);
}

TEST_CASE("a fleet that finds no server ends with that reason", "[bots]") {
  const FlatServer flat;
  BotOptions options = options_for(*flat.server, BotRole::build, 1);
  flat.server->stop();
  options.load_seconds = 0.5;
  const FleetReport report = BehaviourFleet(options).run(never);
  CHECK(report.failure.find("bot does not see the world around it: cannot connect") == 0);
  CHECK(report.counts.due == 0);
}

TEST_CASE("a signal ends the edits of a fleet early, and submitted edits are still answered",
          "[bots]") {
  const FlatServer flat;
  BotOptions options = options_for(*flat.server, BotRole::build, 2);
  options.edits.reset();
  static volatile std::sig_atomic_t stop = 0;
  std::signal(SIGUSR1, [](int) { stop = 1; });
  std::thread signaller([&, fleet = ::pthread_self()] {
    reaches(flat.folder.path(), 30);
    ::pthread_kill(fleet, SIGUSR1);  // the handler runs on the thread that reads the counter
  });
  const FleetReport report = BehaviourFleet(options).run(stop);
  signaller.join();
  CHECK(report.failure.empty());
  CHECK(report.counts.submitted > 20);
  CHECK(report.counts.durable == report.counts.submitted);
  CHECK(report.seconds < 30);
  CHECK(report.counts.rejected == 0);
}

TEST_CASE("with all bots in one place, every bot verifies every edit", "[bots]") {
  const FlatServer flat;
  BotOptions options = options_for(*flat.server, BotRole::build, 50);
  options.sites = 1;
  options.replicas = 5;
  options.join_rate = 500;
  options.rate = 10;
  options.edits = 10;
  const FleetReport report = BehaviourFleet(options).run(never);
  INFO(to_table(report));
  CHECK(report.failure.empty());
  CHECK(report.is_sound());
  CHECK(report.replicas == 5);
  CHECK(report.counts.confirmed == 500);
  CHECK(report.counts.durable == 500);
  CHECK(report.counts.confirm_us.count() == 500);
  // The 45 bots without a replica receive each edit once, also the author.
  CHECK(report.commit_edits == 45 * 500);
  CHECK(report.seen_us.count() >= 45 * 500);
  CHECK(report.seen_us.infinite() == 0);
  CHECK(report.unattributed == 0);
  CHECK(report.versions.followed > 0);
  CHECK(report.versions.snapshots > 45);
  CHECK(report.losses.empty());
  CHECK(report.counts.joins == 50);
}

TEST_CASE("bots of a join storm join again and again, and run-away bots load new views", "[bots]") {
  const FlatServer flat;
  BotOptions options = options_for(*flat.server, BotRole::join_storm, 8);
  options.roles = {BotRole::join_storm, BotRole::run_away};
  options.replicas = 2;
  options.edits = 5;
  options.rate = 20;
  options.view_radius = options.view_radius_v = 1;
  const FleetReport report = BehaviourFleet(options).run(never);
  INFO(to_table(report));
  CHECK(report.failure.empty());
  CHECK(report.is_sound());
  CHECK(report.losses.empty());
  CHECK(report.counts.joins >= 8 + 4 * 4);  // the last join may be in progress
  CHECK(report.counts.submitted == 0);
}
