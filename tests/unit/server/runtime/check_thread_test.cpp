// The check of all rows of a world that is in use.
#include "server/runtime/check_thread.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <thread>

#include "server/runtime/logging.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

constexpr Sequence kEdits = 600;

void make_world(const std::string& folder) {
  SplitMix64 rng(3);
  const auto store = *create_world(folder, sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE(store->append(players, sample_records(rng, 1, 1, kEdits)).has_value());
  const std::vector<std::pair<ChunkKey, ChunkPtr>> chunks = {
      {{0, {0, 0, 0}}, sample_chunk(rng, {1, kEdits})}};
  REQUIRE(store->save_snapshots(chunks, kEdits).has_value());
}

void wait_until(const std::function<bool()>& is_done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!is_done() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  REQUIRE(is_done());
}

/// Returns the faults that a whole round finds.
std::uint64_t faults_of(const std::string& folder) {
  start_logging(LogLevel::error, LogFormat::text);
  CheckThread check(folder);
  wait_until([&] { return check.rounds() == 1; });
  return check.faults();
}

/// Rests for days after its first part.
constexpr CheckPace kOnePart{1'000'000'000, std::chrono::hours(24)};

}  // namespace

TEST_CASE("a check of a sound world finds nothing", "[server][sqlite]") {
  TempFolder folder;
  make_world(folder / "world");
  CHECK(faults_of(folder / "world") == 0);
}

TEST_CASE("a check counts the bytes of the log of edits", "[server][sqlite]") {
  TempFolder folder;
  make_world(folder / "world");
  const std::string bytes =
      raw_sql(folder / "world/world.sqlite", "SELECT sum(length(descriptor)) FROM edit_log");
  start_logging(LogLevel::error, LogFormat::text);
  CheckThread check(folder / "world");
  wait_until([&] { return check.rounds() == 1; });
  CHECK(check.log_bytes() == std::stoull(bytes) + kEdits * CheckThread::kLogRowBytes);
}

TEST_CASE("a check counts damage and reads on", "[server][sqlite]") {
  TempFolder folder;
  make_world(folder / "world");
  const std::string file = folder / "world/world.sqlite";
  // Three records, two of them in one part, and a snapshot.
  REQUIRE(raw_sql(file,
                  "UPDATE edit_log SET time_us = time_us + 1 WHERE seq IN (10, 11, 500); SELECT "
                  "changes()") == "3");
  REQUIRE(raw_sql(file, "UPDATE snapshot SET data = x'00'; SELECT changes()") == "1");
  CHECK(faults_of(folder / "world") == 4);
}

TEST_CASE("a check that cannot read a record of the log gives no size of it", "[server][sqlite]") {
  TempFolder folder;
  make_world(folder / "world");
  REQUIRE(raw_sql(folder / "world/world.sqlite",
                  "UPDATE edit_log SET time_us = time_us + 1 WHERE seq = 10; SELECT changes()") ==
          "1");
  start_logging(LogLevel::error, LogFormat::text);
  CheckThread check(folder / "world");
  wait_until([&] { return check.rounds() == 1; });
  CHECK(check.faults() == 1);
  CHECK(check.log_bytes() == std::nullopt);
}

TEST_CASE("a check of a log that is all damaged costs few errors and ends", "[server][sqlite]") {
  TempFolder folder;
  make_world(folder / "world");
  REQUIRE(raw_sql(folder / "world/world.sqlite",
                  "UPDATE edit_log SET time_us = time_us + 1 WHERE seq < 600; SELECT changes()") ==
          "599");
  const std::uint64_t faults = faults_of(folder / "world");
  CHECK(faults > 5);
  CHECK(faults < 30);
}

TEST_CASE("a check counts a key that no chunk can have", "[server][sqlite]") {
  TempFolder folder;
  make_world(folder / "world");
  REQUIRE(raw_sql(folder / "world/world.sqlite",
                  "UPDATE snapshot SET lod = 256 + lod; SELECT changes()") == "1");
  CHECK(faults_of(folder / "world") == 1);
}

TEST_CASE("a check reads in parts that are bounded", "[server][sqlite]") {
  TempFolder folder;
  make_world(folder / "world");
  start_logging(LogLevel::error, LogFormat::text);
  CheckThread check(folder / "world");
  wait_until([&] { return check.rounds() == 1; });
  // Seven tables of short rows, the extent and the records of the log, the keys of two tables of
  // chunks with one more call that finds no more, the snapshot, and the keys of keyframes.
  CHECK(check.parts() >= 7 + 1 + (kEdits + kCheckPartEdits - 1) / kCheckPartEdits + 3 + 1 + 1);
}

TEST_CASE("a check that rests leaves the write-ahead log free, and ends at once",
          "[server][sqlite]") {
  TempFolder folder;
  make_world(folder / "world");
  start_logging(LogLevel::error, LogFormat::text);
  const auto store = open_world(folder / "world", StoreAccess::read_write);
  REQUIRE(store.has_value());
  CheckThread check(folder / "world", kOnePart);
  wait_until([&] { return check.parts() == 1; });
  REQUIRE((*store)->raise_epoch().has_value());
  SplitMix64 rng(4);
  REQUIRE((*store)->append({}, sample_records(rng, (*store)->epoch(), kEdits + 1, 10)).has_value());
  // The first column is 1 if a reader was in the way.
  CHECK(raw_sql(folder / "world/world.sqlite", "PRAGMA wal_checkpoint(TRUNCATE)") == "0");
  check.stop();
  CHECK(check.parts() == 1);
  CHECK(check.rounds() == 0);
}

TEST_CASE("a check begins again after a pause", "[server][sqlite]") {
  TempFolder folder;
  make_world(folder / "world");
  start_logging(LogLevel::error, LogFormat::text);
  CheckThread check(folder / "world", {0, std::chrono::milliseconds(1)});
  wait_until([&] { return check.rounds() >= 3; });
  CHECK(check.faults() == 0);
}

}  // namespace runstone::test
