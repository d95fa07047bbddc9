// Plays a recorded log on a live server on loopback.
#include <catch2/catch.hpp>
#include <csignal>
#include <thread>

#include "client/fleet/behaviour_fleet.hpp"
#include "client/fleet/play_fleet.hpp"
#include "client/fleet/recorded_file.hpp"
#include "server/replay/rlog_file.hpp"
#include "tests/integration/server/app/server_bench.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

volatile std::sig_atomic_t never_interrupted = 0;

/// Makes a world that three builders edit, each on a separate site. Returns its digest.
Digest build_world(const std::string& folder) {
  auto server = start_server(quiet_config(folder), flat_creation());
  BotOptions options;
  options.server.port = server->port();
  options.count = options.sites = 3;
  options.rate = 300;
  options.edits = 150;
  options.seconds = 60;
  options.view_radius = options.view_radius_v = 3;
  const FleetReport report = BehaviourFleet(options).run(never_interrupted);
  REQUIRE(report.counts.confirmed == 450);
  const StopReport stopped = server->stop();
  REQUIRE(stopped.is_clean);
  return stopped.world_digest;
}

std::string exported(const std::string& folder, const std::string& file) {
  auto store = open_world(folder, StoreAccess::read_only);
  REQUIRE(store.has_value());
  REQUIRE(export_rlog(**store, file, kSequenceMax).has_value());
  return file;
}

PlayReport play(std::uint16_t port, const RecordedLog& log, double speed, double patience = 60) {
  BotOptions options;
  options.server.port = port;
  options.play = "log";
  options.speed = speed;
  options.load_seconds = patience;
  return PlayFleet(options, log).run(never_interrupted);
}

}  // namespace

TEST_CASE("a log played on a fresh server of the same generator gives the same world",
          "[bots][play]") {
  const TempFolder recorded;
  const Digest digest = build_world(recorded.path());
  const auto log = read_recorded_file(exported(recorded.path(), recorded / "all.rlog"));
  REQUIRE(log.has_value());
  REQUIRE(log->authors.size() == 3);
  for (const double speed : {1.0, 0.0}) {
    const TempFolder live;
    auto server = start_server(quiet_config(live.path()), flat_creation());
    const PlayReport report = play(server->port(), *log, speed);
    INFO(to_table(report) << report.failure);
    CHECK(report.is_complete());
    CHECK(report.counts.due == 450);
    CHECK(report.counts.submitted == 450);
    CHECK(report.counts.confirm_us.count() == 450);
    const StopReport stopped = server->stop();
    CHECK(stopped.world_digest == digest);
    CHECK(stopped.digests.seq == 450);
  }
}

TEST_CASE("edits refused by a rate limit are offered again until all are applied", "[bots][play]") {
  const TempFolder recorded, live;
  build_world(recorded.path());
  const auto log = read_recorded_file(exported(recorded.path(), recorded / "all.rlog"));
  REQUIRE(log.has_value());
  ServerConfig config = quiet_config(live.path());
  config.builder_budget = {200, 200};  // slow bots exceed it, too
  config.budgets_per_address = 1;      // for all players of the log together
  auto server = start_server(config, flat_creation());
  const PlayReport report = play(server->port(), *log, 0);
  INFO(to_table(report) << report.failure);
  CHECK(report.is_complete());
  CHECK(report.counts.retried > 0);
  CHECK(report.counts.submitted == 450 + report.counts.retried);
  CHECK(server->stop().digests.seq == 450);
}

TEST_CASE("a play of which the world refuses edits is not complete and gives the reasons",
          "[bots][play]") {
  const TempFolder recorded, live;
  build_world(recorded.path());
  const auto log = read_recorded_file(exported(recorded.path(), recorded / "all.rlog"));
  REQUIRE(log.has_value());
  ServerConfig config = quiet_config(live.path());
  config.reach_max = 30;  // most sites around the spawn are farther away
  auto server = start_server(config, flat_creation());
  const PlayReport report = play(server->port(), *log, 0);
  CHECK(report.failure.empty());
  CHECK_FALSE(report.is_complete());
  CHECK(report.counts.rejected.at("out_of_reach") + report.counts.confirmed == 450);
}

TEST_CASE("a world with other materials gets no edit", "[bots][play]") {
  const TempFolder recorded, live;
  build_world(recorded.path());
  auto log = read_recorded_file(exported(recorded.path(), recorded / "all.rlog"));
  REQUIRE(log.has_value());
  MaterialTable other;
  for (const MaterialInfo& row : log->materials.rows().subspan(1)) {
    MaterialInfo renamed = row;
    renamed.name += " of old";
    REQUIRE(other.add(renamed).has_value());
  }
  log->materials = other;
  auto server = start_server(quiet_config(live.path()), flat_creation());
  const PlayReport report = play(server->port(), *log, 0);
  CHECK_FALSE(report.started);
  CHECK(report.failure.find("log: material ") == 0);
  CHECK(server->stop().digests.seq == 0);
}

TEST_CASE("a play that finds no server, or loses it, ends with that reason", "[bots][play]") {
  const TempFolder recorded, live;
  build_world(recorded.path());
  const auto log = read_recorded_file(exported(recorded.path(), recorded / "all.rlog"));
  REQUIRE(log.has_value());
  auto server = start_server(quiet_config(live.path()), flat_creation());
  const std::uint16_t port = server->port();
  std::thread stopper([&] {
    reaches(live.path(), 1);
    server->stop();
  });
  const PlayReport lost = play(port, *log, 0.01, 2);
  stopper.join();
  CHECK(lost.started);
  CHECK_FALSE(lost.is_complete());
  CHECK(lost.failure.find(" has no connection: ") != std::string::npos);
  const PlayReport none = play(port, *log, 1, 0.3);
  CHECK_FALSE(none.started);
  CHECK(none.failure.find("cannot connect") != std::string::npos);
}

TEST_CASE("the error of a missing file names it", "[bots][play]") {
  const auto log = read_recorded_file("/nowhere/at-all.rlog");
  REQUIRE_FALSE(log.has_value());
  CHECK(log.error().find("/nowhere/at-all.rlog: cannot be read: ") == 0);
  const TempFolder folder;
  const auto no_file = read_recorded_file(folder.path());
  REQUIRE_FALSE(no_file.has_value());
  CHECK(no_file.error() == folder.path() + ": is a folder");
}
