#include "server/runtime/recovery.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/runtime/derived_config.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"
#include "tests/unit/server/world/fake_environment.hpp"

namespace runstone::test {
namespace {

constexpr Sequence kRecords = 6;

std::vector<EditRecord> make_sample_world(const std::string& folder) {
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
  const auto records = make_sample_world(folder / "world");
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
  CHECK(world.order().chunks().version({0, touched.front()}) == records.back().version);
}

TEST_CASE("a start takes the time of the newest record, not the latest time", "[server][clock]") {
  const TempFolder folder;
  const auto records = make_sample_world(folder / "world");
  auto store = open_world(folder / "world", StoreAccess::read_write);
  REQUIRE(store.has_value());
  EditRecord correction;
  correction.version = {1, kRecords + 1};
  correction.op = {0, 1, 1};
  correction.cause = Cause::rights;
  correction.edit = rights_edit(CorrectTime{-1000, 1});
  correction.time_us = records.back().time_us - 1000;
  REQUIRE((*store)->append({}, std::span(&correction, 1)).has_value());
  const auto start = read_world_start(**store);
  REQUIRE(start.has_value());
  CHECK(start->log.last_time_us == correction.time_us);
  REQUIRE(start->rights.size() == 1);
  CHECK(start->rights[0].change == RightsChange(CorrectTime{-1000, 1}));
}

TEST_CASE("the replay begins above the checkpoint", "[server]") {
  const TempFolder folder;
  make_sample_world(folder / "world");
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

TEST_CASE("a start fails if a name or an edit in the middle of the log is missing", "[server]") {
  for (const std::string rows : {"player_name WHERE author = 1", "edit_log WHERE seq = 3"}) {
    const TempFolder folder;
    make_sample_world(folder / "world");
    REQUIRE(raw_sql(folder / "world/world.sqlite",
                    "DELETE FROM " + rows + "; SELECT changes() > 0") == "1");
    auto store = open_world(folder / "world", StoreAccess::read_write);
    REQUIRE(store.has_value());
    const auto start = read_world_start(**store);
    REQUIRE_FALSE(start.has_value());
    CAPTURE(start.error());
    CHECK(start.error().find(rows.substr(0, rows.find(' '))) != std::string::npos);
    CHECK(start.error().find("--accept-losses") != std::string::npos);
  }
}

TEST_CASE("a start fails if a player or a watermark is missing", "[server]") {
  for (const std::string table : {"player", "player_instance"}) {
    const TempFolder folder;
    make_sample_world(folder / "world");
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
  make_sample_world(folder / "world");
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
  make_sample_world(folder / "world");
  REQUIRE(raw_sql(folder / "world/world.sqlite",
                  "UPDATE edit_log SET time_us = time_us + 1 WHERE seq = 6; SELECT changes()") ==
          "1");
  auto store = open_world(folder / "world", StoreAccess::read_write);
  REQUIRE(store.has_value());
  const auto start = read_world_start(**store);
  REQUIRE_FALSE(start.has_value());
  CHECK(start.error().find("edit_log seq=6") != std::string::npos);
}

TEST_CASE("a start goes on without places or a clock that are damaged", "[server]") {
  const auto [key, is_clock] =
      GENERATE(std::pair{"player_places", false}, std::pair{"world_clock", true});
  CAPTURE(key);
  const TempFolder folder;
  const auto records = make_sample_world(folder / "world");
  const SavedState saved{{LastPlace{}}, SavedClock{kRecords + 1, {5, 1}}};
  {
    auto store = open_world(folder / "world", StoreAccess::read_write);
    REQUIRE(store.has_value());
    EditRecord of_clock;
    of_clock.version = {1, kRecords + 1};
    of_clock.op = {0, 1, 1};
    of_clock.cause = Cause::clock;
    of_clock.time_us = records.back().time_us;
    of_clock.edit = clock_edit(saved.clock->time);
    REQUIRE((*store)->append({}, std::span(&of_clock, 1)).has_value());
    REQUIRE((*store)->save_state(saved).has_value());
  }
  REQUIRE(raw_sql(folder / "world/world.sqlite",
                  std::string("UPDATE meta SET checksum = checksum + 1 WHERE key = '") + key +
                      "'; SELECT changes()") == "1");
  auto store = open_world(folder / "world", StoreAccess::read_write);
  REQUIRE(store.has_value());
  const auto start = read_world_start(**store);
  REQUIRE(start.has_value());
  CHECK(start->saved.places == (is_clock ? saved.places : std::vector<LastPlace>()));
  CHECK(start->saved.clock == (is_clock ? std::nullopt : saved.clock));
}

// A takeover by a server that has followed the owner of the world.

/// Returns a part of the log with these records and the rows of both players.
LogPart part_of(std::span<const EditRecord> records) {
  LogPart part;
  for (const AuthorId author : {AuthorId{1}, AuthorId{2}}) {
    const PlayerRow row = sample_player(author);
    part.players.push_back({row.author, row.key, row.name});
  }
  for (const EditRecord& record : records) part.records.push_back({record, 0});
  return part;
}

/// Returns everything that the log of a world holds.
std::vector<EditRecord> log_of(Store& store) {
  std::vector<EditRecord> records;
  const auto last = store.last_sequence();
  REQUIRE(last.has_value());
  const auto read = store.read_log(1, *last, [&](const EditRecord& record) {
    records.push_back(record);
    return true;
  });
  REQUIRE(read.has_value());
  return records;
}

/// A world that an owner has written, and the records that a follower has.
struct TakeoverBench {
  TakeoverBench() {
    records = make_sample_world(folder / "world");
    SplitMix64 rng{2};
    for (EditRecord& record : sample_records(rng, 1, kRecords + 1, 4)) records.push_back(record);
    auto opened = open_world(folder / "world", StoreAccess::read_write);
    REQUIRE(opened.has_value());
    store = *std::move(opened);
  }
  Result<Takeover, std::string> prepare(const std::vector<LogPart>& parts, Version last) {
    return prepare_takeover(*store, parts, last);
  }
  std::span<const EditRecord> some(std::size_t first, std::size_t last) const {
    return std::span(records).subspan(first - 1, last - first + 1);
  }
  void check_unchanged() {
    CHECK(log_of(*store) == std::vector(records.begin(), records.begin() + kRecords));
    CHECK(store->epoch() == 1);
    const auto claims = store->name_claims();
    REQUIRE(claims.has_value());
    CHECK(claims->empty());
    const auto players = store->players();
    REQUIRE(players.has_value());
    CHECK(players->size() == 2);
  }

  TempFolder folder;
  std::vector<EditRecord> records;  // kRecords of them are in the log
  std::unique_ptr<Store> store;
};

TEST_CASE("a takeover writes the records that the log lacks, and no others", "[server]") {
  TakeoverBench bench;
  LogPart first = part_of(bench.some(5, 7));  // two of them are in the log
  first.players[1].name = "renamed";
  LogPart names;
  names.names.push_back({"ana", "Ana", sample_player(1).key, false});
  names.names.push_back({"bob", "Bob", sample_player(2).key, false});
  LogPart release;
  release.names.push_back({"bob", "Bob", sample_player(2).key, true});
  LogPart second = part_of(bench.some(8, 10));
  second.players.erase(second.players.begin(), second.players.end());
  const auto taken = bench.prepare({first, names, release, second}, bench.records[9].version);
  INFO((taken ? "" : taken.error()));
  REQUIRE(taken.has_value());
  CHECK(log_of(*bench.store) == bench.records);
  CHECK(taken->epoch == 2);
  CHECK(bench.store->epoch() == 2);
  CHECK(taken->checkpoint == 0);
  CHECK(taken->author_max == 2);
  CHECK(taken->read.last == 10);
  REQUIRE(taken->read.records.size() == 1);
  CHECK(taken->read.records[0] == bench.records[9]);
  REQUIRE(taken->read.players.size() == 2);
  CHECK(taken->read.players[1].name == "renamed");
  CHECK(taken->read.names == std::vector<NameClaim>{{"ana", "Ana", sample_player(1).key}});
}

TEST_CASE("a takeover reads what the owner wrote and the follower did not get", "[server]") {
  TakeoverBench bench;
  SECTION("the follower has some records") {
    const auto taken = bench.prepare({part_of(bench.some(3, 4))}, bench.records[3].version);
    REQUIRE(taken.has_value());
    CHECK(taken->read.records == std::vector(bench.records.begin() + 3, bench.records.begin() + 6));
    CHECK(taken->read.last == kRecords);
  }
  SECTION("the follower has none") {
    const auto taken = bench.prepare({}, {});
    REQUIRE(taken.has_value());
    CHECK(taken->read.records.size() == kRecords);
  }
  CHECK(log_of(*bench.store).size() == kRecords);
}

TEST_CASE("a takeover fails and writes nothing if the log has other edits", "[server]") {
  TakeoverBench bench;
  LogPart names;
  names.names.push_back({"ana", "Ana", sample_player(1).key, false});
  std::vector<LogPart> parts{names};
  Version last;
  SECTION("the follower's last record is another one") {
    parts.push_back(part_of(bench.some(5, 5)));
    last = {2, 5};
    parts[1].records[0].record.version = last;
  }
  SECTION("the log ends with another record") {
    parts.push_back(part_of(bench.some(5, 8)));
    for (LogPartRecord& record : parts[1].records) record.record.version.epoch = 2;
    last = {2, 8};
  }
  SECTION("the follower has durable records only") { last = {2, kRecords}; }
  const auto taken = bench.prepare(parts, last);
  REQUIRE_FALSE(taken.has_value());
  CHECK(taken.error().find("other edits") != std::string::npos);
  bench.check_unchanged();
}

TEST_CASE("a takeover writes nothing if an owner before it lacked the follower's records",
          "[server]") {
  TakeoverBench bench;
  const auto epoch = bench.store->raise_epoch();
  REQUIRE(epoch.has_value());
  const auto parts = std::vector{part_of(bench.some(5, 8))};
  const auto taken = bench.prepare(parts, bench.records[7].version);
  REQUIRE_FALSE(taken.has_value());
  CHECK(taken.error().find("another server has owned the world since") != std::string::npos);
  CHECK(bench.store->epoch() == *epoch);
  CHECK(log_of(*bench.store).size() == kRecords);
  // Records that are in the log are no reason to refuse.
  const auto in_log = std::vector{part_of(bench.some(5, kRecords))};
  CHECK(bench.prepare(in_log, bench.records[kRecords - 1].version).has_value());
}

TEST_CASE("a takeover fails and writes nothing if records are missing", "[server]") {
  TakeoverBench bench;
  const auto taken = bench.prepare({part_of(bench.some(8, 9))}, bench.records[8].version);
  REQUIRE_FALSE(taken.has_value());
  bench.check_unchanged();
}

TEST_CASE("what a follower has missed is read from its last record on, in portions", "[server]") {
  TakeoverBench bench;
  const auto all = read_missed_log(*bench.store, 1);
  REQUIRE(all.has_value());
  CHECK(all->records.size() == kRecords);
  CHECK(all->last == kRecords);
  CHECK(all->players.size() == 2);
  const auto some = read_missed_log(*bench.store, 3, 2);
  REQUIRE(some.has_value());
  CHECK(some->records == std::vector(bench.records.begin() + 2, bench.records.begin() + 4));
  CHECK(some->last == kRecords);
  const auto none = read_missed_log(*bench.store, kRecords + 1);
  REQUIRE(none.has_value());
  CHECK(none->records.empty());
}

}  // namespace
}  // namespace runstone::test
