// The check of all rows of a world that is in use.
#include "server/runtime/check_thread.hpp"

#include <catch2/catch.hpp>
#include <chrono>
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

/// Reads all rows once.
void wait_for_round(const CheckThread& check) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (check.rounds() == 0 && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  CHECK(check.rounds() == 1);
}

/// Returns the faults that a whole round finds.
std::uint64_t faults_of(const std::string& folder) {
  start_logging(LogLevel::error, LogFormat::text);
  CheckThread check(folder);
  wait_for_round(check);
  return check.faults();
}

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
  wait_for_round(check);
  CHECK(check.log_bytes() == std::stoull(bytes) + kEdits * CheckThread::kLogRowBytes);
}

TEST_CASE("a check counts damage and reads on", "[server][sqlite]") {
  TempFolder folder;
  make_world(folder / "world");
  const std::string file = folder / "world/world.sqlite";
  // Two parts of the log, and a snapshot.
  REQUIRE(raw_sql(file,
                  "UPDATE edit_log SET time_us = time_us + 1 WHERE seq IN (10, 500); SELECT "
                  "changes()") == "2");
  REQUIRE(raw_sql(file, "UPDATE snapshot SET data = x'00'; SELECT changes()") == "1");
  CHECK(faults_of(folder / "world") == 3);
}

TEST_CASE("a check ends at once", "[server][sqlite]") {
  TempFolder folder;
  make_world(folder / "world");
  start_logging(LogLevel::error, LogFormat::text);
  const auto begun = std::chrono::steady_clock::now();
  {
    CheckThread check(folder / "world");
  }
  CHECK(std::chrono::steady_clock::now() - begun < std::chrono::seconds(20));
}

}  // namespace runstone::test
