#include "server/admin/server_health.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "common/core/version.hpp"
#include "server/admin/amount_text.hpp"
#include "server/admin/command_table.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kSecondUs = 1'000'000;

struct HealthBench : CommandBench {
  HealthBench()
      : services{
            bench.server, service, *this, placing, folder.path(), actions(), [](const PublicKey&) {
              return false;
            }} {}
  std::string status() {
    answers.clear();
    give_command({services, {}, bench.now(), reply()}, "status");
    return answer().text;
  }
  ServerHealth health;
  CommandServices services;

 private:
  OperatorActions actions() {
    OperatorActions all;
    all.health = [this] { return health; };
    return all;
  }
};

}  // namespace

TEST_CASE("a duration is written in its two largest units", "[admin]") {
  CHECK(uptime_text(0) == "0 s");
  CHECK(uptime_text(999'999) == "0 s");
  CHECK(uptime_text(61 * kSecondUs) == "1 min 1 s");
  CHECK(uptime_text(3'600 * kSecondUs) == "1 h");
  CHECK(uptime_text((3 * 86'400 + 4 * 3'600 + 59) * kSecondUs) == "3 d 4 h");
}

TEST_CASE("a count of bytes is written in its largest unit", "[admin]") {
  CHECK(byte_count_text(0) == "0 bytes");
  CHECK(byte_count_text(1'023) == "1023 bytes");
  CHECK(byte_count_text(1'024) == "1.0 KiB");
  CHECK(byte_count_text(1'536 * 1'024) == "1.5 MiB");
  CHECK(byte_count_text(std::uint64_t{5} << 40) == "5120.0 GiB");
}

TEST_CASE("status shows version, uptime, disk and durable lag", "[admin][status]") {
  HealthBench bench;
  bench.health = {90 * kSecondUs, 3 << 20, 2 << 20, 1 << 20, 1 << 10, 12'345};
  const std::string text = bench.status();
  CHECK(text.starts_with("runstone " + std::string(version()) + ", up 1 min 30 s\nsessions 0"));
  CHECK(contains(text,
                 "\ndisk: 3.0 MiB free, world 2.0 MiB, its log of edits 1.0 KiB, its write-ahead "
                 "log 1.0 MiB, oldest edit that is not on disk 12 ms old"));
  CHECK_FALSE(contains(text, "READ-ONLY"));
  bench.health = {};
  CHECK(contains(bench.status(), "\ndisk: oldest edit that is not on disk none"));
}

TEST_CASE("status shows a full disk, and a log that is lost", "[admin][status]") {
  HealthBench bench;
  bench.bench.server.set_disk_is_full(true, bench.bench.now());
  CHECK(contains(bench.status(), "\nREAD-ONLY: edits are refused: " + std::string(kDiskIsFull)));
  bench.bench.server.set_disk_is_full(true, bench.bench.now(), kDatabaseIsReadOnly);
  CHECK(contains(bench.status(), std::string(kDatabaseIsReadOnly)));
  bench.bench.server.set_disk_is_full(false, bench.bench.now());
  CHECK_FALSE(contains(bench.status(), "READ-ONLY"));
  bench.bench.server.log_failed();
  CHECK(contains(bench.status(), "READ-ONLY: edits are refused: the log cannot be written"));
}

}  // namespace runstone::test
