// Worlds that have lost rows of players or of watermarks, although every row that is left is sound.
#include <catch2/catch.hpp>
#include <string>

#include "server/store/store.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/compact_by_hand.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr Sequence kLostPlayerEdits = 30;

/// Makes a closed world with two players, who have two client processes each. One of them was
/// renamed.
void make_peopled_world(const std::string& place) {
  SplitMix64 rng(8);
  const auto store = *create_world(place, sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE(store->append(players, sample_records(rng, 1, 1, kLostPlayerEdits - 1)).has_value());
  PlayerRow renamed = sample_player(2);
  renamed.name = "another name";
  REQUIRE(store->append({&renamed, 1}, sample_records(rng, 1, kLostPlayerEdits, 1)).has_value());
}

std::unique_ptr<Store> peopled_world(const std::string& place, StoreAccess access) {
  auto store = open_world(place, access);
  if (!store) FAIL(store.error().message());
  return *std::move(store);
}

void delete_row(TempPlace& place, const std::string& from) {
  REQUIRE(raw_sql(place / "world.sqlite", "DELETE FROM " + from + "; SELECT changes()") == "1");
}

constexpr const char* kOneWatermark =
    "player_instance WHERE author = 2 AND instance = (SELECT min(instance) FROM player_instance)";

/// Returns the cause in the error about a table that does not have the rows that `meta` counts.
std::string wrong_rows(const std::string& counts) {
  return "rows vanished, appeared or changed: " + counts +
         ". Put the world back from a backup, or run `runstone-server repair`, or start the server "
         "once with --accept-losses";
}

}  // namespace

TEST_CASE("a missing player is noticed and named, and the number stays taken", "[store][loss]") {
  TempPlace place;
  make_peopled_world(place.path());
  delete_row(place, "player WHERE author = 2");
  const auto store = peopled_world(place.path(), StoreAccess::read_write);
  const auto players = store->players();
  REQUIRE_FALSE(players.has_value());
  CHECK(players.error().kind == StoreError::Kind::corrupt);
  CHECK(players.error().where == "player");
  CHECK(players.error().what == wrong_rows("1 rows, meta counts 2, none for author=2"));
  CHECK(store->author_max() == 2);
  const auto checked = store->check();
  REQUIRE_FALSE(checked.has_value());
  CHECK(checked.error().message() == players.error().message());
}

TEST_CASE("a missing player whose edits were compacted away is noticed", "[store][loss]") {
  TempPlace place;
  make_peopled_world(place.path());
  compact_by_hand(place / "world.sqlite", {{1, kLostPlayerEdits}, 1}, {});
  delete_row(place, "player WHERE author = 1");
  const auto store = peopled_world(place.path(), StoreAccess::read_only);
  const auto players = store->players();
  REQUIRE_FALSE(players.has_value());
  CHECK(players.error().what == wrong_rows("1 rows, meta counts 2"));
}

TEST_CASE("a player's row in an older state is noticed", "[store][loss]") {
  TempPlace place, before_renaming;
  make_peopled_world(place.path());
  {
    const auto store = *create_world(before_renaming.path(), sample_meta());
    const PlayerRow player = sample_player(2);
    REQUIRE(store->append({&player, 1}, {}).has_value());
  }
  const std::string checksum =
      raw_sql(before_renaming / "world.sqlite", "SELECT checksum FROM player");
  REQUIRE(raw_sql(place / "world.sqlite",
                  "UPDATE player SET name = 'builder 2', checksum = " + checksum +
                      " WHERE author = 2; SELECT changes()") == "1");
  const auto players = peopled_world(place.path(), StoreAccess::read_only)->players();
  REQUIRE_FALSE(players.has_value());
  CHECK(players.error().where == "player");
  CHECK(players.error().what.find("2 rows, meta counts 2") != std::string::npos);
}

TEST_CASE("a missing watermark is noticed, also without its edits in the log", "[store][loss]") {
  TempPlace place;
  make_peopled_world(place.path());
  compact_by_hand(place / "world.sqlite", {{1, kLostPlayerEdits}, 1}, {});
  CHECK(peopled_world(place.path(), StoreAccess::read_only)->high_waters()->size() == 4);
  delete_row(place, kOneWatermark);
  const auto store = peopled_world(place.path(), StoreAccess::read_write);
  const auto marks = store->high_waters();
  REQUIRE_FALSE(marks.has_value());
  CHECK(marks.error().where == "player_instance");
  CHECK(marks.error().what == wrong_rows("3 rows, meta counts 4"));
}

TEST_CASE("lost rows are accepted once: watermarks come back from the log", "[store][loss]") {
  TempPlace place;
  make_peopled_world(place.path());
  const auto before = *peopled_world(place.path(), StoreAccess::read_only)->high_waters();
  delete_row(place, "player WHERE author = 2");
  delete_row(place, kOneWatermark);
  {
    const auto store = peopled_world(place.path(), StoreAccess::repair);
    const auto lost = store->accept_losses();
    REQUIRE(lost.has_value());
    REQUIRE(lost->size() == 2);
    CHECK(lost->at(0).find("player: rows vanished") != std::string::npos);
    CHECK(lost->at(1).find("player_instance: rows vanished") != std::string::npos);
    CHECK(store->accept_losses()->empty());
  }
  const auto store = peopled_world(place.path(), StoreAccess::read_write);
  REQUIRE(store->players().has_value());
  CHECK(store->players()->size() == 1);
  CHECK(store->author_max() == 2);
  const auto after = store->high_waters();
  REQUIRE(after.has_value());
  REQUIRE(after->size() == before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    CHECK(after->at(i).author == before[i].author);
    CHECK(after->at(i).instance == before[i].instance);
    CHECK(after->at(i).resolved == before[i].resolved);
    CHECK(after->at(i).last_us == before[i].last_us);
  }
  CHECK(store->check().has_value());
}

TEST_CASE("a batch that is refused changes no fold", "[store][loss]") {
  TempPlace place;
  make_peopled_world(place.path());
  SplitMix64 rng(9);
  const auto store = peopled_world(place.path(), StoreAccess::read_write);
  const std::vector<PlayerRow> players = {sample_player(3), sample_player(0)};  // 0 is the server
  REQUIRE_FALSE(
      store->append(players, sample_records(rng, 1, kLostPlayerEdits + 1, 3)).has_value());
  CHECK(store->players()->size() == 2);
  CHECK(store->high_waters().has_value());
  CHECK(store->author_max() == 2);
}
