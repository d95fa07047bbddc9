#include "server/runtime/counters_line.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <span>

#include "tests/unit/server/world/fake_environment.hpp"

namespace runstone::test {
namespace {

TEST_CASE("the line of counters shows each part of the server", "[server]") {
  FakeEnvironment environment;
  WorldStart start;
  start.log.last = 7;
  start.checkpoint = 5;
  WorldServer world(WorldConfig{}, start, environment,
                    [](std::span<std::uint8_t> out) { std::ranges::fill(out, 9); });
  world.connected(1, {});
  NetCounters net;
  net.bytes_out = 1'234;
  net.commit_send_ns = 9'000'000;
  LogWriter::Counters log;
  log.keyframes = 3;
  RuntimeCounters runtime{11, 12, 13, 14, 15};
  runtime.health = {7'000'000, 21, 22, std::nullopt, 24, 25};
  runtime.durable_waits.add(600);
  const std::string line = counters_line(world, net, log, runtime);
  INFO(line);
  CHECK(line.rfind("counters connections=0 refused=0 sessions=1 ", 0) == 0);
  for (const char* field : {" epoch=1 owns_world=1 follows_owner=0 followers=0 ",
                            " seq=7 ",
                            " durable=7 ",
                            " checkpoint=5 ",
                            " keyframes=3 ",
                            " snapshots_encoded=11 ",
                            " commit_enqueue_us=12 ",
                            " commit_send_ms=9 ",
                            " bytes_out=1234 ",
                            " chunk_bytes_out=0 ",
                            " memory_bytes=13 ",
                            " log_lines_dropped=14 ",
                            " row_faults=15 retention_days=0 ",
                            " edit_wait_count=0 ",
                            " edit_wait_ms_le_1000=0 ",
                            " uptime_s=7 read_only=0 durable_lag_us=25 disk_free_bytes=21 ",
                            " world_bytes=22 log_bytes=24 ",
                            " durable_wait_count=1 durable_wait_us=600 ",
                            " durable_wait_ms_le_1=1 ",
                            " dense_expansions=0"}) {
    CAPTURE(field);
    CHECK(line.find(field) != std::string::npos);
  }
  CHECK(line.find('\n') == std::string::npos);
  CHECK(line.find("wal_bytes") == std::string::npos);  // not known
  CHECK(line.find("backup_") == std::string::npos);
  RuntimeCounters with_backups{11, 12, 13, 14, 15};
  with_backups.backups = BackupState{};
  with_backups.backups->failures = 16;
  const std::string longer = counters_line(world, net, log, with_backups);
  CHECK(longer.find(" retention_failures=0 backup_next_s=0 backup_failures=16 uptime_s=0 ") !=
        std::string::npos);
}

}  // namespace
}  // namespace runstone::test
