#include "server/store/copy_stored_world.hpp"

#include <catch2/catch.hpp>

#include "common/tiles/tile_rules.hpp"
#include "server/store/store.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr Sequence kCopiedEdits = 3'000;  // more than a copy reads at a time

constexpr std::int32_t kCopiedChunks = 128;  // twice as many as a copy reads at a time

/// The places of base chunks, snapshots and tiles: those of one x differ in y and z.
ChunkCoord nth_place(std::int32_t i) { return {i / 16 - 4, i / 4 % 4 - 2, 40 + i % 4}; }

/// Makes a world with rows in every table but `rights_record`. The store is still open.
std::unique_ptr<Store> make_copied_world(const std::string& place) {
  SplitMix64 rng(1);
  auto store = *create_world(place, sample_meta());
  std::vector<std::pair<ChunkKey, ChunkPtr>> base, snapshots, tiles;
  for (std::int32_t i = 0; i < kCopiedChunks; ++i) {
    base.emplace_back(ChunkKey{0, nth_place(i)}, sample_chunk(rng, {}));
    tiles.emplace_back(ChunkKey{2, nth_place(i)}, sample_chunk(rng, {1, 20}));
    if (i > 0) snapshots.emplace_back(ChunkKey{0, nth_place(i)}, sample_chunk(rng, {1, 10}));
  }
  REQUIRE(store->save_base(base).has_value());
  REQUIRE(store->raise_epoch().has_value());
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE(store->append(players, sample_records(rng, 1, 1, kCopiedEdits)).has_value());
  REQUIRE(store->save_snapshots(snapshots, 12).has_value());
  REQUIRE(store->save_tiles(tiles, kTileRules).has_value());
  const std::vector<NameChange> names = {{{"ana", "Ana", sample_player(1).key}},
                                         {{"ben", "Ben", sample_player(2).key}}};
  REQUIRE(store->change_names(names).has_value());
  return store;
}

/// Returns the records that a read passes on.
template <class Read>
std::vector<EditRecord> passed_records(const Read& read) {
  std::vector<EditRecord> records;
  const auto done = read([&](const EditRecord& record) {
    records.push_back(record);
    return true;
  });
  if (!done) FAIL(done.error().message());
  return records;
}

void check_same_worlds(const std::string& first, const std::string& second) {
  auto a = *open_world(first, StoreAccess::read_only);
  auto b = *open_world(second, StoreAccess::read_only);
  CHECK(a->meta().world_id == b->meta().world_id);
  CHECK(a->meta().materials == b->meta().materials);
  CHECK(a->epoch() == b->epoch());
  CHECK(*a->checkpoint() == *b->checkpoint());
  const auto log = [](Store& store) {
    return passed_records([&](const auto& each) { return store.read_log(1, kSequenceMax, each); });
  };
  CHECK(log(*a).size() == kCopiedEdits);
  CHECK(log(*a) == log(*b));
  LogQuery query;
  query.box = VoxelBox{{-8, -8, -8}, {9, 9, 9}};
  const auto in_box = [&](Store& store) {
    return passed_records([&](const auto& each) { return store.query_log(query, each); });
  };
  CHECK(in_box(*a).size() > 10);
  CHECK(in_box(*a) == in_box(*b));
  CHECK(a->players()->size() == 2);
  CHECK(a->high_waters()->size() == b->high_waters()->size());
  CHECK(*a->name_claims() == *b->name_claims());
  CHECK(b->name_claims()->size() == 2);
  CHECK(a->player_names()->size() == b->player_names()->size());
  CHECK(*a->snapshot_keys() == *b->snapshot_keys());
  CHECK(*a->tile_keys(kTileRules) == *b->tile_keys(kTileRules));
  CHECK(b->tile_keys(kTileRules)->size() == kCopiedChunks);
  for (std::int32_t i = 0; i < kCopiedChunks; ++i) {
    CAPTURE(i);
    const ChunkKey key{0, nth_place(i)}, tile{2, nth_place(i)};
    CHECK(*a->load_base(key) == *b->load_base(key));
    CHECK(*a->load_snapshot(key) == *b->load_snapshot(key));
    CHECK(*a->load_tile(tile, kTileRules) == *b->load_tile(tile, kTileRules));
  }
  CHECK(b->check().has_value());
}

}  // namespace

TEST_CASE("a copy of a world has all its rows, there and back", "[store][copy]") {
  TempPlace place;
  const TempFolder folder;
  auto writer = make_copied_world(place / "original");  // SQLite has the rows in its WAL still
  std::uint64_t shown = 0;
  const auto there = copy_stored_world(place / "original", folder / "copy",
                                       [&](std::uint64_t rows, std::uint64_t all) {
                                         CHECK(rows <= all);
                                         shown = rows;
                                       });
  REQUIRE(there.has_value());
  CHECK(there->last == kCopiedEdits);
  CHECK(there->rows > kCopiedEdits);
  CHECK(shown > 0);
  writer.reset();
  check_same_worlds(place / "original", folder / "copy");
  const auto back = copy_stored_world(folder / "copy", place / "back");
  REQUIRE(back.has_value());
  CHECK(back->rows == there->rows);
  check_same_worlds(place / "original", place / "back");
  auto goes_on = *open_world(place / "back", StoreAccess::read_write);
  CHECK(*goes_on->raise_epoch() == 2);
  SplitMix64 rng(2);
  CHECK(goes_on->append({}, sample_records(rng, 2, kCopiedEdits + 1, 3)).has_value());
  CHECK(goes_on->check().has_value());
}

TEST_CASE("a world is not copied onto another, and a damaged one not at all", "[store][copy]") {
  TempPlace place;
  make_copied_world(place / "original").reset();
  make_copied_world(place / "other").reset();
  const auto onto = copy_stored_world(place / "original", place / "other");
  REQUIRE_FALSE(onto.has_value());
  CHECK(onto.error().kind == StoreError::Kind::exists);
  const auto none = copy_stored_world(place / "none", place / "new");
  REQUIRE_FALSE(none.has_value());
  CHECK(none.error().kind == StoreError::Kind::not_a_world);
  raw_sql(place / "original/world.sqlite", "UPDATE edit_log SET author = 9 WHERE seq = 7");
  const auto damaged = copy_stored_world(place / "original", place / "new");
  REQUIRE_FALSE(damaged.has_value());
  CHECK(damaged.error().where == "edit_log seq=7");
}
