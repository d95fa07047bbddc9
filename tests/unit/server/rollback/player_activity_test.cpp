#include "server/rollback/player_activity.hpp"

#include <map>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "tests/unit/server/rollback/rollback_bench.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kMinuteUs = TimeUs{60} * 1'000'000;

/// A world with a log that the test makes.
struct ActivityBench {
  ActivityBench() : store(*create_world(folder / "world", sample_meta())) {
    REQUIRE(store->raise_epoch().has_value());
  }
  void edit(AuthorId author, TimeUs time_us, Cause cause = Cause::player) {
    EditRecord record;
    record.version = {1, records.size() + 1};
    record.op = {author, 1, records.size() + 1};
    record.time_us = time_us;
    record.cause = cause;
    record.edit = {FillBox{{{0, 0, 0}, {static_cast<std::int32_t>(author), 2, 3}}}, {}, 1};
    records.push_back(record);
  }
  void write() {
    const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
    REQUIRE(store->append(players, records).has_value());
  }

  TempFolder folder;
  std::unique_ptr<Store> store;
  std::vector<EditRecord> records;
};

}  // namespace

TEST_CASE("the activity of players is counted from the log", "[rollback][activity]") {
  ActivityBench bench;
  const TimeUs start = TimeUs{1'000'000} * kMinuteUs;
  bench.edit(1, start);
  bench.edit(2, start + 1 * kMinuteUs);
  bench.edit(1, start + 4 * kMinuteUs);
  bench.edit(1, start + 30 * kMinuteUs);  // a new stretch
  bench.edit(1, start + 35 * kMinuteUs);
  bench.edit(1, start + 36 * kMinuteUs, Cause::undo);
  bench.edit(2, start + 90 * kMinuteUs);
  bench.write();
  const auto all = read_activity(*bench.store, {}, 10);
  REQUIRE(all.has_value());
  CHECK(all->is_complete);
  CHECK(all->from_us == start);
  REQUIRE(all->players.size() == 2);
  const PlayerActivity& first = all->players[0];
  CHECK(first.author == 1);
  CHECK(first.edits == 4);
  CHECK(first.voxels == 4 * 6);
  CHECK(first.building_us == 9 * kMinuteUs);
  CHECK(first.first_us == start);
  CHECK(first.last_us == start + 35 * kMinuteUs);
  CHECK(all->players[1].edits == 2);
  CHECK(all->players[1].building_us == 0);

  SelectionFilter late;
  late.from_us = start + 30 * kMinuteUs;
  const auto later = read_activity(*bench.store, late, 1);
  REQUIRE(later.has_value());
  CHECK(later->players_found == 2);
  REQUIRE(later->players.size() == 1);
  CHECK(later->players[0].edits == 2);
  CHECK(later->players[0].building_us == 5 * kMinuteUs);
  CHECK(later->players[0].first_us == start);  // of the whole log

  SelectionFilter of_second;
  of_second.authors = {2};
  const auto second = read_activity(*bench.store, of_second, 10);
  REQUIRE(second.has_value());
  REQUIRE(second->players.size() == 1);
  CHECK(second->players[0].author == 2);
}

TEST_CASE("the activity of a log of many windows is that of a plain count",
          "[rollback][activity]") {
  ActivityBench bench;
  SplitMix64 rng(5);
  TimeUs now = 1'000'000 * kMinuteUs;
  for (int i = 0; i < 15'000; ++i) {
    now += static_cast<TimeUs>(rng.next() % 8) * kMinuteUs;
    bench.edit(1 + static_cast<AuthorId>(rng.next() % 2), now);
  }
  bench.write();
  std::map<AuthorId, PlayerActivity> plain;
  for (const EditRecord& record : bench.records) {
    PlayerActivity& activity = plain[record.op.author];
    if (activity.edits++ == 0) activity.first_us = record.time_us;
    const TimeUs gap = record.time_us - activity.last_us;
    if (activity.edits > 1 && gap <= 5 * kMinuteUs) activity.building_us += gap;
    activity.last_us = record.time_us;
  }
  const auto report = read_activity(*bench.store, {}, 10);
  REQUIRE(report.has_value());
  REQUIRE(report->players.size() == 2);
  for (const PlayerActivity& player : report->players) {
    CAPTURE(player.author);
    CHECK(player.edits == plain[player.author].edits);
    CHECK(player.building_us == plain[player.author].building_us);
    CHECK(player.first_us == plain[player.author].first_us);
    CHECK(player.last_us == plain[player.author].last_us);
  }
}

TEST_CASE("an empty log has no activity", "[rollback][activity]") {
  ActivityBench bench;
  const auto report = read_activity(*bench.store, {}, 10);
  REQUIRE(report.has_value());
  CHECK(report->players.empty());
  CHECK(report->is_complete);
}

}  // namespace runstone::test
