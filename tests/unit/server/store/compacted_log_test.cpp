// A log whose beginning was compacted into the base continues where it was, and base and log never
// overlap.
#include <catch2/catch.hpp>

#include "server/store/sqlite_backend.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/compact_by_hand.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr ChunkKey kKey{0, {1, 0, -3}};

/// Makes a world of `count` edits with an imported chunk at kKey, and closes it. Returns the last
/// edit.
EditRecord make_world(const std::string& place, SplitMix64& rng, std::size_t count) {
  auto store = *create_world(place, sample_meta());
  const std::vector<std::pair<ChunkKey, ChunkPtr>> base = {{kKey, sample_chunk(rng, {})}};
  REQUIRE(store->save_base(base).has_value());
  REQUIRE(store->raise_epoch().has_value());
  const auto records = sample_records(rng, 1, 1, count);
  REQUIRE(store->append({}, records).has_value());
  REQUIRE(store->save_snapshots({}, count).has_value());
  return records.back();
}

LogEnd end_of(const EditRecord& record) { return {record.version, record.time_us}; }

std::unique_ptr<Store> compacted_store(const std::string& place) {
  auto store = open_world(place, StoreAccess::read_write);
  if (!store) FAIL(store.error().message());
  return *std::move(store);
}

}  // namespace

TEST_CASE("the range of a log that was never compacted begins at 1", "[store]") {
  TempPlace place;
  SplitMix64 rng(1);
  CHECK(*(*create_world(place / "new", sample_meta()))->log_range() == LogRange{});
  const EditRecord last = make_world(place / "old", rng, 7);
  CHECK(*compacted_store(place / "old")->log_range() == LogRange{1, {{1, 7}, last.time_us}});
}

TEST_CASE("a log that was compacted to its end does not begin at 1 again", "[store]") {
  TempPlace place;
  SplitMix64 rng(2);
  const LogEnd head = end_of(make_world(place.path(), rng, 7));
  compact_by_hand(place / "world.sqlite", head, {{kKey, sample_chunk(rng, {1, 5})}});
  auto store = compacted_store(place.path());
  CHECK(*store->log_range() == LogRange{8, head});
  CHECK(*store->last_sequence() == 7);
  CHECK(*store->checkpoint() == 7);
  std::size_t read = 0;
  REQUIRE(
      store->read_log(1, kSequenceMax, [&](const EditRecord&) { return ++read > 0; }).has_value());
  CHECK(read == 0);
  REQUIRE(*store->raise_epoch() == 2);
  CHECK(store->append({}, sample_records(rng, 2, 1, 1)).error().kind ==
        StoreError::Kind::bad_request);
  const auto more = sample_records(rng, 2, 8, 3);
  REQUIRE(store->append({}, more).has_value());
  CHECK(*store->log_range() == LogRange{8, end_of(more.back())});
  REQUIRE(store
              ->read_log(1, kSequenceMax,
                         [&](const EditRecord& record) { return record == more[read++]; })
              .has_value());
  CHECK(read == 3);
  const std::vector<std::pair<ChunkKey, ChunkPtr>> late = {{{0, {8, 8, 8}}, sample_chunk(rng, {})}};
  CHECK(store->save_base(late).error().kind == StoreError::Kind::bad_request);
  CHECK(store->check().has_value());
}

TEST_CASE("changes of rights are kept when the log is compacted", "[store]") {
  TempPlace place;
  SplitMix64 rng(5);
  std::vector<EditRecord> written;
  {
    auto store = *create_world(place / "w", sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    auto records = sample_records(rng, 1, 1, 40);
    for (const Sequence seq : {3U, 17U, 20U, 31U}) {
      records[seq - 1].cause = Cause::rights;
      records[seq - 1].edit = sample_rights_edit(rng);
      records[seq - 1].subject = 0;
    }
    for (const EditRecord& record : records) {
      if (record.cause == Cause::rights) written.push_back(record);
    }
    REQUIRE(store->append({}, records).has_value());
    const Keyframe keyframe{{records[19].version, records[19].time_us}, 0, {}};
    REQUIRE(store->save_keyframe({}, keyframe).has_value());
  }
  const auto rights_of = [](WorldReader& store) {
    std::vector<EditRecord> found;
    REQUIRE(store
                .read_rights([&](const EditRecord& record) {
                  found.push_back(record);
                  return true;
                })
                .has_value());
    return found;
  };
  const auto store = compacted_store(place / "w");
  CHECK(rights_of(*store) == written);
  REQUIRE(store->compact(20).has_value());
  CHECK(store->log_range()->first == 21);
  CHECK(rights_of(*store) == written);
  CHECK(store->check().has_value());
}

TEST_CASE("a lost change of rights is noticed", "[store][damage]") {
  TempPlace place;
  {
    auto store = *create_world(place / "w", sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    SplitMix64 rng(6);
    auto record = sample_record(rng, 1, 1);
    record.cause = Cause::rights;
    record.edit = sample_rights_edit(rng);
    record.subject = 0;
    REQUIRE(store->append({}, std::vector{record}).has_value());
    REQUIRE(
        store->save_keyframe({}, Keyframe{{record.version, record.time_us}, 0, {}}).has_value());
    REQUIRE(store->compact(1).has_value());
  }
  raw_sql(place / "w/world.sqlite", "DELETE FROM rights_record");
  const auto store = compacted_store(place / "w");
  const auto read = store->read_rights([](const EditRecord&) { return true; });
  REQUIRE_FALSE(read.has_value());
  CHECK(read.error().kind == StoreError::Kind::corrupt);
  CHECK(read.error().message().find("rights_record") != std::string::npos);
}

TEST_CASE("a base chunk carries the version at which it was completed", "[store]") {
  TempPlace place;
  SplitMix64 rng(3);
  const LogEnd head = end_of(make_world(place.path(), rng, 7));
  const ChunkPtr completed = sample_chunk(rng, {1, 5});
  compact_by_hand(place / "world.sqlite", head, {{kKey, completed}, {{0, {9, 9, 9}}, completed}});
  auto store = compacted_store(place.path());
  const auto loaded = store->load_base(kKey);
  REQUIRE((loaded.has_value() && loaded->has_value()));
  CHECK((*loaded)->version == Version{1, 5});
  CHECK((*loaded)->voxels == completed->voxels);
  CHECK(store->load_base({0, {9, 9, 9}})->has_value());
  CHECK(store->check().has_value());
}

TEST_CASE("a base chunk is only ever replaced by a newer one", "[store]") {
  TempPlace place;
  SplitMix64 rng(4);
  make_world(place.path(), rng, 7);
  auto database = open_database(place / "world.sqlite");
  REQUIRE(database.has_value());
  auto base = *ChunkTable::open(*database, ChunkTable::Kind::base);
  RowFold fold;
  const auto saved = [&](Version version) {
    const auto result = base.save(kKey, *sample_chunk(rng, version), kSampleEdge, fold);
    return result ? std::string("saved") : result.error().what;
  };
  CHECK(saved({1, 5}) == "saved");
  CHECK(saved({1, 5}) == "is there already");
  CHECK(saved({1, 4}) == "is older than the stored version");
  CHECK(saved({1, 6}) == "saved");
}

TEST_CASE("a log that does not fit its head is noticed", "[store][damage]") {
  SplitMix64 rng(5);
  /// Returns the place of the damage that log_range() finds after `sql` ran on a world of 12 edits,
  /// compacted up to edit 7.
  const auto where = [&](const std::string& sql) {
    TempPlace place;
    make_world(place.path(), rng, 7);
    auto head = LogEnd{};
    {
      auto store = compacted_store(place.path());
      head = store->log_range()->last;
      REQUIRE(store->append({}, sample_records(rng, 1, 8, 5)).has_value());
    }
    compact_by_hand(place / "world.sqlite", head, {});
    REQUIRE(raw_sql(place / "world.sqlite", sql).empty());
    auto store = compacted_store(place.path());
    const auto range = store->log_range();
    return range ? store->check() ? "fine" : store->check().error().where : range.error().where;
  };
  CHECK(where("UPDATE edit_log SET seq = seq WHERE seq < 0") == "fine");
  CHECK(where("DELETE FROM edit_log WHERE seq = 8") == "edit_log seq=8");
  CHECK(where("UPDATE edit_log SET seq = 7 WHERE seq = 8") == "edit_log seq=7");
  CHECK(where("UPDATE edit_log SET seq = -8 WHERE seq = 8") ==
        "edit_log seq=" + std::to_string(static_cast<Sequence>(-8)));
  CHECK(where("UPDATE edit_log SET epoch = -1 WHERE seq = 12") == "edit_log seq=12");
}

TEST_CASE("base chunks that hold edits of the log, and a head beyond the checkpoint, are noticed",
          "[store][damage]") {
  SplitMix64 rng(6);
  const auto verdict = [&](Version base, const LogEnd& head) {
    TempPlace place;
    make_world(place.path(), rng, 7);
    {
      auto store = compacted_store(place.path());
      REQUIRE(store->append({}, sample_records(rng, 1, 8, 5)).has_value());
    }
    compact_by_hand(place / "world.sqlite", head, {{kKey, sample_chunk(rng, base)}});
    const auto checked = compacted_store(place.path())->check();
    return checked ? "" : checked.error().where + " " + checked.error().what;
  };
  CHECK(verdict({1, 7}, {{1, 7}, 5}).empty());
  CHECK(verdict({1, 8}, {{1, 7}, 5}) ==
        "base chunk=1,0,-3 holds edits that are in the log as well");
  CHECK(verdict({1, 7}, {{1, 9}, 5}) == "edit_log begins at seq=10, behind the checkpoint seq=7");
}
