// Tests the state that a world stores besides its log (the places of players and the clock), and
// the format of a world whose clock was set.
#include <catch2/catch.hpp>

#include "server/store/copy_stored_world.hpp"
#include "server/store/meta_table.hpp"
#include "server/store/world_schema.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

constexpr WorldTime kEvening{75'600'000, 20};

EditRecord record_of_clock(Sequence seq, const WorldTime& time, Epoch epoch = 1) {
  EditRecord record;
  record.version = {epoch, seq};
  record.op = {0, 5, seq};
  record.time_us = 1'700'000'000'000'000 + static_cast<TimeUs>(seq) * 1000;
  record.cause = Cause::clock;
  record.edit = clock_edit(time);
  return record;
}

LastPlace place_of(std::uint8_t who, double x) {
  LastPlace place;
  place.key.fill(who);
  place.pose = {{x, 64.25, -1e6}, 65'535, -16'384};
  return place;
}

}  // namespace

TEST_CASE("a world has no clock and no places until they are saved", "[store][saved_state]") {
  TempPlace place;
  auto store = *create_world(place / "w", sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  CHECK(store->saved_places()->empty());
  CHECK(*store->saved_clock() == std::nullopt);
  // A clock that no record has set is left out.
  REQUIRE(store->save_state({{place_of(1, 7.5)}, SavedClock{3, kEvening}}).has_value());
  CHECK(*store->saved_places() == std::vector{place_of(1, 7.5)});
  CHECK(*store->saved_clock() == std::nullopt);
}

TEST_CASE("the newest record sets the clock, and its time is saved over and over",
          "[store][saved_state]") {
  TempPlace place;
  {
    auto store = *create_world(place / "w", sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(store->append({}, std::vector{record_of_clock(1, {5, 1}), record_of_clock(2, kEvening)})
                .has_value());
    CHECK(*store->saved_clock() == SavedClock{2, kEvening});
    const WorldTime on = later(kEvening, 9'000'000);
    REQUIRE(store->save_state({{place_of(2, 1), place_of(1, 2)}, SavedClock{2, on}}).has_value());
    REQUIRE(store->save_state({{place_of(2, 1), place_of(1, 2)}, SavedClock{1, {}}}).has_value());
    CHECK(*store->saved_clock() == SavedClock{2, on});
  }
  const auto store = *open_world(place / "w", StoreAccess::read_only);
  CHECK(*store->saved_clock() == SavedClock{2, later(kEvening, 9'000'000)});
  CHECK(*store->saved_places() == std::vector{place_of(2, 1), place_of(1, 2)});
  CHECK(store->check().has_value());
}

TEST_CASE("a spawn that is saved is that of the world from the next start on",
          "[store][saved_state]") {
  TempPlace place;
  {
    auto store = *create_world(place / "w", sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(store->save_state({{}, std::nullopt, WorldPos{1.5, -2, 3}}).has_value());
    REQUIRE(store->save_state({{place_of(1, 7.5)}, std::nullopt}).has_value());
  }
  const auto store = *open_world(place / "w", StoreAccess::read_only);
  CHECK(store->meta().spawn == WorldPos{1.5, -2, 3});
  CHECK(store->check().has_value());
}

TEST_CASE("the clock stays when its record is compacted away", "[store][saved_state]") {
  TempPlace place;
  auto store = *create_world(place / "w", sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  SplitMix64 rng(7);
  auto records = sample_records(rng, 1, 1, 12);
  records[2] = record_of_clock(3, kEvening);
  REQUIRE(store->append({}, records).has_value());
  REQUIRE(store->save_keyframe({}, Keyframe{{records[9].version, records[9].time_us}, 0, {}})
              .has_value());
  REQUIRE(store->compact(10).has_value());
  CHECK(*store->saved_clock() == SavedClock{3, kEvening});
}

TEST_CASE("a world is of format 10 from the first clock on, and so is a copy",
          "[store][saved_state]") {
  TempPlace place;
  const std::string world = place / "w", copy = place / "copy";
  {
    auto store = *create_world(world, sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(store->save_state({{place_of(1, 7.5)}, std::nullopt}).has_value());
    CHECK(stored_format(world) == std::to_string(kWorldFormat));
    REQUIRE(store->append({}, std::vector{record_of_clock(1, kEvening)}).has_value());
  }
  CHECK(stored_format(world) == std::to_string(kWorldFormatOfClock));
  REQUIRE(copy_stored_world(world, copy).has_value());
  {
    auto store = *open_world(copy, StoreAccess::read_write);
    CHECK(*store->saved_places() == std::vector{place_of(1, 7.5)});
    CHECK(*store->saved_clock() == SavedClock{1, kEvening});
    CHECK(store->check().has_value());
  }
  CHECK(stored_format(copy) == std::to_string(kWorldFormatOfClock));
}

TEST_CASE("a world is of format 12 from the first role for some time on, and so is a copy",
          "[store][rights]") {
  TempPlace place;
  const std::string world = place / "w", copy = place / "copy";
  const auto record_of_grant = [](Sequence seq, TimeUs until_us) {
    EditRecord record = record_of_clock(seq, kEvening);
    record.cause = Cause::rights;
    record.edit = rights_edit(GrantRole{PublicKey{1}, "moderator", until_us});
    return record;
  };
  {
    auto store = *create_world(world, sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(store->append({}, std::vector{record_of_grant(1, 0)}).has_value());
    CHECK(stored_format(world) == std::to_string(kWorldFormat));
    REQUIRE(store->append({}, std::vector{record_of_grant(2, 5)}).has_value());
  }
  CHECK(stored_format(world) == std::to_string(kWorldFormatOfTimedGrants));
  REQUIRE(copy_stored_world(world, copy).has_value());
  CHECK((*open_world(copy, StoreAccess::read_write))->check().has_value());
  CHECK(stored_format(copy) == std::to_string(kWorldFormatOfTimedGrants));
}

TEST_CASE("damaged places and a damaged clock end neither the opening nor the writing",
          "[store][saved_state]") {
  TempPlace place;
  if (place.is_postgres()) return;
  const std::string world = place / "w";
  {
    auto store = *create_world(world, sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(store->append({}, std::vector{record_of_clock(1, kEvening)}).has_value());
    REQUIRE(store->save_state({{place_of(1, 7.5)}, SavedClock{1, kEvening}}).has_value());
  }
  const auto [key, is_clock] = GENERATE(std::pair{kPlacesKey, false}, std::pair{kClockKey, true});
  CAPTURE(key);
  REQUIRE(raw_sql(world + "/world.sqlite", "UPDATE meta SET checksum = checksum + 1 WHERE key = '" +
                                               std::string(key) + "'; SELECT changes()") == "1");
  CHECK_FALSE(copy_stored_world(world, place / "copy").has_value());
  auto opened = open_world(world, StoreAccess::read_write);
  REQUIRE(opened.has_value());
  const auto store = *std::move(opened);
  CHECK(store->saved_places().has_value() == is_clock);
  CHECK(store->saved_clock().has_value() == !is_clock);
  const auto checked = store->check();
  REQUIRE_FALSE(checked.has_value());
  CHECK(checked.error().kind == StoreError::Kind::corrupt);
  CHECK(checked.error().message().find(key) != std::string::npos);

  REQUIRE(store->raise_epoch().has_value());
  REQUIRE(store->save_state({{place_of(2, 1)}, std::nullopt}).has_value());
  CHECK(*store->saved_places() == std::vector{place_of(2, 1)});
  REQUIRE(store->append({}, std::vector{record_of_clock(2, {5, 1}, 2)}).has_value());
  CHECK(*store->saved_clock() == SavedClock{2, {5, 1}});
  CHECK(store->check().has_value());
}

TEST_CASE("a place beyond the world is an error that names the places", "[store][saved_state]") {
  TempPlace place;
  if (place.is_postgres()) return;
  auto store = *create_world(place / "w", sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  LastPlace beyond = place_of(1, 1e300);
  REQUIRE(store->save_state({{beyond}, std::nullopt}).has_value());
  const auto read = store->saved_places();
  REQUIRE_FALSE(read.has_value());
  CHECK(read.error().kind == StoreError::Kind::corrupt);
  CHECK(read.error().message().find("player_places") != std::string::npos);
}

}  // namespace runstone::test
