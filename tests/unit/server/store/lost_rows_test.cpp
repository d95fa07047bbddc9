// Worlds that have lost rows which a start does not read: base chunks, names, keyframes, edits in the
// middle of the log; and snapshots and segments of the log, which can be made again.
#include <catch2/catch.hpp>
#include <string>

#include "server/store/store.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

constexpr Sequence kFullWorldEdits = 12;
constexpr std::size_t kFullWorldChunks = 5;

std::unique_ptr<Store> full_world(const std::string& place, StoreAccess access) {
  auto store = open_world(place, access);
  if (!store) FAIL(store.error().message());
  return *std::move(store);
}

/// Makes a closed world with rows in every table that has no other protection.
void make_full_world(const std::string& place) {
  SplitMix64 rng(8);
  const auto store = *create_world(place, sample_meta());
  std::vector<std::pair<ChunkKey, ChunkPtr>> base, snapshots;
  for (std::size_t i = 0; i < kFullWorldChunks; ++i) {
    const ChunkKey key{0, {static_cast<std::int32_t>(i), 0, 0}};
    base.emplace_back(key, sample_chunk(rng, {}));
    snapshots.emplace_back(key, sample_chunk(rng, {1, kFullWorldEdits}));
  }
  REQUIRE(store->save_base(base).has_value());
  REQUIRE(store->raise_epoch().has_value());
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE(store->append(players, sample_records(rng, 1, 1, kFullWorldEdits)).has_value());
  REQUIRE(store->save_snapshots(snapshots, kFullWorldEdits).has_value());
  const LogEnd end = store->log_range()->last;
  REQUIRE(store->save_keyframe({}, Keyframe{end, 0, {}}).has_value());
}

/// Returns the error of check_counts(), without the name of the file.
std::string counted(Store& store) {
  const auto done = store.check_counts();
  if (done) return "";
  CHECK(done.error().kind == StoreError::Kind::corrupt);
  return done.error().where + ": " + done.error().what;
}

constexpr const char* kWayOn =
    "Put the world back from a backup, or run `runstone-server repair`, or start the server once "
    "with --accept-losses";

struct LostRows {
  const char* rows;
  std::string error;
};

const std::vector<LostRows>& all_lost_rows() {
  static const std::vector<LostRows> all = {
      {"base", "base: 5 rows are missing: 0 rows, meta counts 5. " + std::string(kWayOn) +
                   ": the generator's ground then takes their place"},
      {"base WHERE x = 3", "base: 1 rows are missing: 4 rows, meta counts 5. " +
                               std::string(kWayOn) +
                               ": the generator's ground then takes their place"},
      {"player_name WHERE author = 2",
       "player_name: 1 rows are missing: 1 rows, meta counts 2. " + std::string(kWayOn)},
      {"keyframe", "keyframe: 1 rows are missing: 0 rows, meta counts 1. " + std::string(kWayOn)},
      {"edit_log WHERE seq = 5",
       "edit_log seq=5: is missing; the log lacks 1 edits in all. " + std::string(kWayOn) +
           ": the present ground stays as the snapshots have it, and what needs these edits, such "
           "as the past and rollbacks of them, fails"}};
  return all;
}

}  // namespace

TEST_CASE("missing rows of base, names, keyframes and log are counted, named and accepted once",
          "[store][loss]") {
  for (const LostRows& lost : all_lost_rows()) {
    TempPlace place;
    const std::string rows = lost.rows;
    // Counting the log would read all of it in PostgreSQL.
    if (place.is_postgres() && rows.starts_with("edit_log")) continue;
    CAPTURE(rows);
    make_full_world(place.path());
    CHECK(counted(*full_world(place.path(), StoreAccess::read_write)).empty());
    REQUIRE(raw_sql(place / "world.sqlite", "DELETE FROM " + rows + "; SELECT changes()") != "0");
    CHECK(counted(*full_world(place.path(), StoreAccess::read_write)) == lost.error);
    CHECK(counted(*full_world(place.path(), StoreAccess::read_only)) == lost.error);
    {
      const auto store = full_world(place.path(), StoreAccess::repair);
      const auto accepted = store->accept_losses();
      REQUIRE(accepted.has_value());
      REQUIRE(accepted->size() == 1);
      CHECK(accepted->front().find(lost.error) != std::string::npos);
      CHECK(counted(*store).empty());
      CHECK(store->raise_epoch().has_value());
    }
    CHECK(counted(*full_world(place.path(), StoreAccess::read_write)).empty());
    CHECK(full_world(place.path(), StoreAccess::repair)->accept_losses()->empty());
  }
}

TEST_CASE("missing segments of the log are counted, named and made again from the log",
          "[store][loss]") {
  TempPlace place;
  make_full_world(place.path());
  const std::string file = place / "world.sqlite";
  const std::string count = "SELECT count(*) FROM log_box";
  const std::string sum =
      "SELECT sum(first_seq * 100000 + last_seq * 1000 + author * 10 + min_x + max_z) FROM log_box";
  const std::string rows = raw_sql(file, count), sum_before = raw_sql(file, sum);
  REQUIRE(std::stoi(rows) > 0);
  for (const std::string where : {"", " WHERE first_seq = (SELECT max(first_seq) FROM log_box)"}) {
    CAPTURE(where);
    static_cast<void>(raw_sql(file, "DELETE FROM log_box" + where));
    const std::string left = raw_sql(file, count);
    const std::string error = "log_box: " + std::to_string(std::stoi(rows) - std::stoi(left)) +
                              " rows are missing: " + left + " rows, meta counts " + rows + ". " +
                              kWayOn +
                              ", which makes this index again from the log: no edit is lost";
    CHECK(counted(*full_world(place.path(), StoreAccess::read_write)) == error);
    CHECK(counted(*full_world(place.path(), StoreAccess::read_only)) == error);
    {
      const auto store = full_world(place.path(), StoreAccess::repair);
      const auto accepted = store->accept_losses();
      REQUIRE(accepted.has_value());
      REQUIRE(accepted->size() == 1);
      CHECK(accepted->front().find(error) != std::string::npos);
      CHECK(counted(*store).empty());
      CHECK(store->raise_epoch().has_value());
    }
    CHECK(raw_sql(file, count) == rows);
    CHECK(raw_sql(file, sum) == sum_before);
    CHECK(counted(*full_world(place.path(), StoreAccess::read_write)).empty());
  }
}

TEST_CASE("an accepted gap in the log does not hide a later one", "[store][loss][sqlite]") {
  TempPlace place;
  make_full_world(place.path());
  REQUIRE(raw_sql(place / "world.sqlite", "DELETE FROM edit_log WHERE seq = 5").empty());
  {
    const auto store = full_world(place.path(), StoreAccess::repair);
    REQUIRE(store->accept_losses()->size() == 1);
    REQUIRE(store->raise_epoch().has_value());
  }
  REQUIRE(raw_sql(place / "world.sqlite", "DELETE FROM edit_log WHERE seq = 7").empty());
  CHECK(counted(*full_world(place.path(), StoreAccess::read_write)).find("lacks 2 edits") !=
        std::string::npos);
}

TEST_CASE("counts follow the world: renamed players, keyframes, compactions and starts",
          "[store][loss]") {
  TempPlace place;
  make_full_world(place.path());
  Epoch epoch = 1;
  Sequence seq = kFullWorldEdits;
  SplitMix64 rng(3);
  for (int run = 0; run < 4; ++run) {
    CAPTURE(run);
    const auto store = full_world(place.path(), StoreAccess::read_write);
    CHECK(counted(*store).empty());
    epoch = *store->raise_epoch();
    for (int name = 0; name < 9; ++name) {
      PlayerRow renamed = sample_player(2);
      renamed.name = "name " + std::to_string(run) + std::to_string(name);
      REQUIRE(store->append({&renamed, 1}, sample_records(rng, epoch, ++seq, 1)).has_value());
      CHECK(counted(*store).empty());
    }
    const LogEnd end = store->log_range()->last;
    REQUIRE(store->save_keyframe({}, Keyframe{end, 0, {}}).has_value());
    if (run == 2) {
      REQUIRE(store->compact(end.version.seq).has_value());
      CHECK(counted(*store).empty());
    }
  }
  CHECK(full_world(place.path(), StoreAccess::read_only)->player_names()->size() == 17);
  REQUIRE_FALSE(raw_sql(place / "world.sqlite", "DELETE FROM keyframe; SELECT changes()") == "0");
  CHECK(
      counted(*full_world(place.path(), StoreAccess::read_write)).starts_with("keyframe: 1 rows"));
}

TEST_CASE("a world of an older program, without counts, is counted by its next start",
          "[store][loss]") {
  TempPlace place;
  make_full_world(place.path());
  const std::string file = place / "world.sqlite";
  static_cast<void>(raw_sql(file, "DELETE FROM meta WHERE key IN ('row_counts', 'open_epoch')"));
  static_cast<void>(raw_sql(file, "DELETE FROM player_name WHERE author = 2"));
  {
    const auto store = full_world(place.path(), StoreAccess::read_write);
    CHECK(counted(*store).empty());  // nobody counted them
    REQUIRE(store->raise_epoch().has_value());
  }
  static_cast<void>(raw_sql(file, "DELETE FROM player_name WHERE author = 1"));
  CHECK(counted(*full_world(place.path(), StoreAccess::read_write))
            .starts_with("player_name: 1 rows"));
}

TEST_CASE("missing snapshots are refused with a way on, and made again from base and log",
          "[store][loss]") {
  TempPlace place;
  make_full_world(place.path());
  static_cast<void>(raw_sql(place / "world.sqlite", "DELETE FROM snapshot WHERE x < 2"));
  const auto keys = full_world(place.path(), StoreAccess::read_write)->snapshot_keys();
  REQUIRE_FALSE(keys.has_value());
  CHECK(keys.error().where == "snapshot");
  CHECK(keys.error().what ==
        "rows vanished, appeared or changed their key or version: 3 rows, meta counts 5. " +
            std::string(kWayOn) + ", which makes the snapshots again: no edit is lost");
  const auto store = full_world(place.path(), StoreAccess::repair);
  const auto accepted = store->accept_losses();
  REQUIRE(accepted.has_value());
  REQUIRE(accepted->size() == 1);
  CHECK(accepted->front().find("makes them again from base and log") != std::string::npos);
  CHECK(store->snapshot_keys()->size() == 3);
  CHECK(*store->checkpoint() == 0);  // the start puts every edit on the chunks that lack it
}

}  // namespace runstone::test
