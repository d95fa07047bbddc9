// Backups that a server makes by itself while it runs the world.
#include "server/app/backup_schedule.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <sstream>
#include <thread>

#include "server/backup/backup_folder.hpp"
#include "server/backup/backup_program.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

namespace fs = std::filesystem;

/// Waits until the state is as wanted, for a minute at most. Returns the last state.
BackupState state_when(const BackupSchedule& schedule,
                       const std::function<bool(const BackupState&)>& wanted) {
  for (int i = 0; i < 600; ++i) {
    if (wanted(schedule.state())) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return schedule.state();
}

/// A server that makes backups by itself, as the program has it.
struct ScheduledServer {
  explicit ScheduledServer(const BackupPlan& plan) : schedule(plan) {
    ::setenv("RUNSTONE_SERVER", RUNSTONE_SERVER_PROGRAM, 1);
    OperatorActions actions;
    actions.backup_state = [this] { return schedule.state(); };
    auto started = Server::start(quiet_config(plan.world), flat_creation(), [] {}, actions);
    REQUIRE(started.has_value());
    server = *std::move(started);
    schedule.start();
  }
  ~ScheduledServer() { schedule.stop(); }

  BackupSchedule schedule;
  std::unique_ptr<Server> server;
};

}  // namespace

TEST_CASE("a server makes a backup by itself, and its status shows it", "[integration]") {
  const TempFolder folder;
  const std::string world = folder / "world", backups = folder / "backups";
  fs::create_directory(backups);
  {
    ScheduledServer running({world, backups, 3'600, BackupPolicy{}});
    const BackupState state =
        state_when(running.schedule, [](const BackupState& now) { return now.last.has_value(); });
    INFO(state.failure);
    REQUIRE(state.last.has_value());
    CHECK(state.last->bytes > 0);
    CHECK(state.failures == 0);
    CHECK(state.next_s > 3'000);
    const Answer status = control(world, {"status"});
    CHECK(contains(status.text, "backups: last " + state.last->name));
    CHECK(contains(status.text, "next in "));
  }
  std::ostringstream out;
  const auto restored = restore({backups, folder / "back", false}, 1'795'000'000'000'000, out);
  INFO((restored ? "" : restored.error()));
  REQUIRE(restored.has_value());
  const auto server = start_server(quiet_config(folder / "back"), flat_creation());
  RawClient client(server->port());
  CHECK(client.join(1).has_value());
}

TEST_CASE("a backup that fails is shown, and the server plays on", "[integration]") {
  const TempFolder folder;
  const std::string world = folder / "world", backups = folder / "backups";
  ScheduledServer running({world, backups, 60, BackupPolicy{}});
  const BackupState state =
      state_when(running.schedule, [](const BackupState& now) { return now.failures > 0; });
  CHECK(state.failures == 1);
  CHECK(state.failure == backups + ": is no folder: make it, or mount its disk");
  CHECK_FALSE(state.last.has_value());
  CHECK(contains(control(world, {"status"}).text, "BACKUPS FAIL, 1 time: " + state.failure));
  RawClient client(running.server->port());
  CHECK(client.join(1).has_value());
}

TEST_CASE("two servers do not make their backups in one folder", "[integration]") {
  const TempFolder folder;
  const std::string backups = folder / "backups";
  fs::create_directory(backups);
  ScheduledServer first({folder / "first", backups, 3'600, BackupPolicy{}});
  const BackupState made =
      state_when(first.schedule, [](const BackupState& now) { return now.last.has_value(); });
  REQUIRE(made.last.has_value());
  ScheduledServer second({folder / "second", backups, 3'600, BackupPolicy{}});
  const BackupState refused =
      state_when(second.schedule, [](const BackupState& now) { return now.failures > 0; });
  CHECK(refused.failure == backups + ": another server makes its backups there");
  CHECK_FALSE(refused.last.has_value());
  CHECK(BackupFolder::open(backups)->entries()->size() == 1);
}

}  // namespace runstone::test
