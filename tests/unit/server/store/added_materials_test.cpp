// The material table of a world on disk: records of the log append to it, and a compaction keeps it.
#include <catch2/catch.hpp>

#include "server/store/sqlite_backend.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

EditRecord record_of_rows(Sequence seq, Material first, const std::vector<std::string>& names) {
  AddedMaterials added{first, {}};
  for (const std::string& name : names)
    added.rows.push_back({name, {1, 2, 3, 90}, Visibility::transparent});
  EditRecord record;
  record.version = {1, seq};
  record.op = {0, 5, seq};
  record.time_us = 1'700'000'000'000'000 + static_cast<TimeUs>(seq) * 1000;
  record.cause = Cause::materials;
  record.edit = materials_edit(std::move(added));
  return record;
}

std::unique_ptr<Store> opened_world(const std::string& place) {
  auto store = open_world(place, StoreAccess::read_write);
  if (!store) FAIL(store.error().message());
  return *std::move(store);
}

/// Makes a world whose edits 5 and 20 of 30 add materials, with a keyframe at 10.
MaterialTable make_world_with_wool(const std::string& place) {
  auto store = *create_world(place, sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  SplitMix64 rng(7);
  auto records = sample_records(rng, 1, 1, 30);
  const auto first = static_cast<Material>(store->meta().materials.size());
  records[4] = record_of_rows(5, first, {"lime", "teal"});
  records[19] = record_of_rows(20, static_cast<Material>(first + 2), {"plum"});
  REQUIRE(store->append({}, records).has_value());
  REQUIRE(store->save_keyframe({}, Keyframe{{records[9].version, records[9].time_us}, 0, {}})
              .has_value());
  return store->meta().materials;
}

}  // namespace

TEST_CASE("the material table grows with the log, from sequence to sequence",
          "[store][materials]") {
  TempPlace place;
  const MaterialTable pinned = make_world_with_wool(place / "w");
  const auto store = opened_world(place / "w");
  CHECK(store->meta().materials == pinned);
  CHECK(*store->materials(4) == pinned);
  CHECK(store->materials(5)->size() == pinned.size() + 2);
  CHECK(store->materials(19)->size() == pinned.size() + 2);
  const MaterialTable all = *store->materials();
  CHECK(all.size() == pinned.size() + 3);
  CHECK(all.find("plum") == static_cast<Material>(pinned.size() + 2));
  CHECK(all[*all.find("lime")].visibility == Visibility::transparent);
  CHECK(store->check().has_value());
}

TEST_CASE("added materials are kept when the log is compacted", "[store][materials]") {
  TempPlace place;
  const MaterialTable pinned = make_world_with_wool(place / "w");
  MaterialTable all;
  {
    const auto store = opened_world(place / "w");
    const auto reader = *open_world(place / "w", StoreAccess::read_only);  // opened before
    all = *store->materials();
    REQUIRE(store->compact(10).has_value());
    CHECK(store->log_range()->first == 11);
    CHECK(*store->materials() == all);
    CHECK(*reader->materials() == all);
    CHECK(store->meta().materials.size() == pinned.size() + 2);
    CHECK(store->check().has_value());
  }
  const auto store = opened_world(place / "w");
  CHECK(store->meta().materials.size() == pinned.size() + 2);
  CHECK(*store->materials() == all);
  const auto next = static_cast<Material>(all.size());
  REQUIRE(*store->raise_epoch() == 2);
  EditRecord more = record_of_rows(31, next, {"navy"});
  more.version.epoch = 2;
  CHECK(store->append({}, std::vector{more}).has_value());
  CHECK(store->materials()->find("navy") == next);
}

TEST_CASE("records that do not continue the material table are refused", "[store][materials]") {
  TempPlace place;
  const auto store = *create_world(place / "w", sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  const auto first = static_cast<Material>(store->meta().materials.size());
  const auto refused = [&](const std::vector<EditRecord>& records) {
    for (const bool is_history : {false, true}) {
      const auto written =
          is_history ? store->append_history({}, records) : store->append({}, records);
      REQUIRE_FALSE(written.has_value());
      CHECK(written.error().kind == StoreError::Kind::bad_request);
      CHECK(*store->last_sequence() == 0);
    }
  };
  refused({record_of_rows(1, static_cast<Material>(first + 1), {"lime"})});
  refused({record_of_rows(1, static_cast<Material>(first - 1), {"lime"})});
  refused({record_of_rows(1, first, {"lime", store->meta().materials[1].name})});
  refused({record_of_rows(1, first, {"lime"}), record_of_rows(2, first, {"teal"})});
  CHECK(store
            ->append({}, std::vector{record_of_rows(1, first, {"lime"}),
                                     record_of_rows(2, static_cast<Material>(first + 1), {"teal"})})
            .has_value());
}

TEST_CASE("a damaged or lost record of materials is noticed", "[store][materials][damage]") {
  TempPlace place;
  make_world_with_wool(place / "w");
  std::string where;
  SECTION("damaged") {
    raw_sql(
        place / "w/world.sqlite",
        "UPDATE edit_log SET descriptor = (SELECT descriptor FROM edit_log WHERE seq = 4) WHERE seq = 5");
    where = "seq=5";
  }
  SECTION("lost") {
    raw_sql(place / "w/world.sqlite", "DELETE FROM edit_log WHERE seq = 5");
    where = "seq=20";  // which does not continue the table
  }
  SECTION("damaged after a compaction") {
    REQUIRE(opened_world(place / "w")->compact(10).has_value());
    const std::string value = place.is_postgres() ? "text_value" : "value";
    raw_sql(place / "w/world.sqlite", "UPDATE meta SET " + value + " = replace(" + value +
                                          ", 'lime', 'limo') WHERE key = 'materials'");
    const auto store = open_world(place / "w", StoreAccess::read_write);
    REQUIRE_FALSE(store.has_value());
    CHECK(store.error().message().find("meta key=materials") != std::string::npos);
    return;
  }
  const auto store = opened_world(place / "w");
  const auto read = store->materials();
  REQUIRE_FALSE(read.has_value());
  CHECK(read.error().kind == StoreError::Kind::corrupt);
  CHECK(read.error().message().find(where) != std::string::npos);
  CHECK_FALSE(store->check().has_value());
}

}  // namespace runstone::test
