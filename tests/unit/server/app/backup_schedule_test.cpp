// When a server makes backups by itself.
#include "server/app/backup_schedule.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <thread>

#include "server/runtime/logging.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/unit/server/app/backup_script.hpp"

namespace runstone::test {

TEST_CASE("the next backup follows the last one, whatever the clock did", "[backup]") {
  CHECK(next_backup_us(std::nullopt, 1'000, 60) == 1'000);
  CHECK(next_backup_us(990, 1'000, 60) == 1'050);
  CHECK(next_backup_us(10, 1'000, 60) == 70);  // long ago: at once
  CHECK(next_backup_us(5'000, 1'000, 60) == 1'060);
}

TEST_CASE("a backup that was made and cannot be read is not made again at once", "[backup]") {
  start_logging(LogLevel::error, LogFormat::text);
  const BackupScript script("echo made >> \"$FOLDER/calls\"\n");
  const TempFolder folder;
  std::filesystem::create_directory(folder / "backups");
  // No world is there, so it cannot be known which backups are of it.
  BackupSchedule schedule({folder / "world", folder / "backups", 86'400, BackupPolicy{}});
  schedule.start();
  CHECK(script.written("calls") == "made\n");
  for (int i = 0; i < 600 && schedule.state().next_s < 80'000; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const BackupState state = schedule.state();
  CHECK(state.next_s >= 80'000);
  CHECK(state.failures == 0);
  CHECK_FALSE(state.last.has_value());
  schedule.stop();
  CHECK(script.written("calls") == "made\n");
  // It is no folder of backups yet, so nothing was put into it.
  CHECK(std::filesystem::is_empty(folder / "backups"));
}

TEST_CASE("settings without a sound plan for backups are refused with words", "[backup]") {
  const TempFolder folder;
  ServerConfig config;
  config.world = folder / "world";
  config.backup_folder = folder / "backups";
  REQUIRE(backup_plan_of(config).has_value());
  CHECK_FALSE(backup_plan_of(config)->has_value());  // backup_every is 0
  config.backup_every_s = 3'600;
  config.backup_keep_daily = 5;
  const auto plan = backup_plan_of(config);
  REQUIRE(plan.has_value());
  CHECK(*plan == BackupPlan{folder / "world", folder / "backups", 3'600, BackupPolicy{24, 5, 8}});
  const auto refused = [&](const std::string& why) {
    const auto none = backup_plan_of(config);
    REQUIRE_FALSE(none.has_value());
    CAPTURE(none.error());
    CHECK(none.error().find(why) != std::string::npos);
  };
  for (const std::string& inner :
       {folder / "world", folder / "world/backups", folder / "world/../world", folder.path()}) {
    config.backup_folder = inner;
    refused("must not lie in each other");
  }
  config.backup_folder = "";
  refused("backup_every = 1h: backup_folder is missing");
  config.backup_folder = folder / "backups";
  config.store = "postgresql://h/d";
  refused("pg_dump");
}

}  // namespace runstone::test
