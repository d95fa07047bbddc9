#include "server/runtime/recovery.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <span>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/runtime/derived_config.hpp"
#include "tests/support/raw_sql.hpp"
#include "tests/support/sample_world.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/unit/server/world/fake_environment.hpp"

namespace runstone::test {
namespace {

constexpr Sequence kRecords = 6;

std::vector<EditRecord> make_world(const std::string& folder) {
  SplitMix64 rng{1};
  auto store = create_world(folder, sample_meta());
  REQUIRE(store.has_value());
  REQUIRE((*store)->raise_epoch().has_value());
  auto records = sample_records(rng, 1, 1, kRecords);
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE((*store)->append(players, records).has_value());
  return records;
}

TEST_CASE("a start reads the state of the store and replays its log", "[server]") {
  const TempFolder folder;
  const auto records = make_world(folder / "world");
  auto store = open_world(folder / "world", StoreAccess::read_write);
  REQUIRE(store.has_value());
  const auto start = read_world_start(**store);
  REQUIRE(start.has_value());
  CHECK(start->log.last == kRecords);
  CHECK(start->log.last_time_us == records.back().time_us);
  CHECK(start->checkpoint == 0);
  CHECK(start->players.size() == 2);
  CHECK(start->author_max == 2);
  CHECK_FALSE(start->resolved.empty());
  CHECK((*store)->epoch() == 1);  // reading raises no epoch

  FakeEnvironment environment;
  WorldServer world(world_config_of(ServerConfig{}, sample_meta(), 4747), *start, environment,
                    [](std::span<std::uint8_t> out) { std::ranges::fill(out, 9); });
  const auto replayed = replay_log(**store, *start, world);
  REQUIRE(replayed.has_value());
  CHECK(*replayed == kRecords);
  const auto touched = touched_chunks(records.back().edit, kSampleEdge);
  REQUIRE_FALSE(touched.empty());
  CHECK(world.chunk_version({0, touched.front()}) == records.back().version);
}

TEST_CASE("the replay begins above the checkpoint", "[server]") {
  const TempFolder folder;
  make_world(folder / "world");
  auto store = open_world(folder / "world", StoreAccess::read_write);
  REQUIRE(store.has_value());
  REQUIRE((*store)->save_snapshots({}, Sequence{4}).has_value());
  const auto start = read_world_start(**store);
  REQUIRE(start.has_value());
  CHECK(start->checkpoint == 4);
  FakeEnvironment environment;
  WorldServer world(world_config_of(ServerConfig{}, sample_meta(), 4747), *start, environment,
                    [](std::span<std::uint8_t> out) { std::ranges::fill(out, 9); });
  const auto replayed = replay_log(**store, *start, world);
  REQUIRE(replayed.has_value());
  CHECK(*replayed == 2);
}

TEST_CASE("a start fails if a player or a watermark is missing", "[server]") {
  for (const std::string table : {"player", "player_instance"}) {
    const TempFolder folder;
    make_world(folder / "world");
    REQUIRE(raw_sql(folder / "world/world.sqlite",
                    "DELETE FROM " + table + " WHERE author = 1; SELECT changes() > 0") == "1");
    auto store = open_world(folder / "world", StoreAccess::read_write);
    REQUIRE(store.has_value());
    const auto start = read_world_start(**store);
    REQUIRE_FALSE(start.has_value());
    CHECK(start.error().find(table + ": rows vanished") != std::string::npos);
  }
}

TEST_CASE("a start fails on a damaged name of a player and names it", "[server]") {
  const TempFolder folder;
  make_world(folder / "world");
  REQUIRE(raw_sql(folder / "world/world.sqlite",
                  "UPDATE player_name SET name = 'x' WHERE author = 2; SELECT changes()") == "1");
  auto store = open_world(folder / "world", StoreAccess::read_write);
  REQUIRE(store.has_value());
  const auto start = read_world_start(**store);
  REQUIRE_FALSE(start.has_value());
  CHECK(start.error().find("player_name author=2 number=1") != std::string::npos);
}

TEST_CASE("a start fails on a damaged last record and names it", "[server]") {
  const TempFolder folder;
  make_world(folder / "world");
  REQUIRE(raw_sql(folder / "world/world.sqlite",
                  "UPDATE edit_log SET time_us = time_us + 1 WHERE seq = 6; SELECT changes()") ==
          "1");
  auto store = open_world(folder / "world", StoreAccess::read_write);
  REQUIRE(store.has_value());
  const auto start = read_world_start(**store);
  REQUIRE_FALSE(start.has_value());
  CHECK(start.error().find("edit_log seq=6") != std::string::npos);
}

}  // namespace
}  // namespace runstone::test
