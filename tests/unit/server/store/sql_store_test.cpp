#include "server/store/sqlite_backend.hpp"

#include <sqlite3.h>

#include <catch2/catch.hpp>
#include <map>

#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

std::unique_ptr<Store> created(const std::string& place) {
  auto store = create_world(place, sample_meta());
  if (!store) FAIL(store.error().message());
  return *std::move(store);
}

std::unique_ptr<Store> opened(const std::string& place,
                              StoreAccess access = StoreAccess::read_write) {
  auto store = open_world(place, access);
  if (!store) FAIL(store.error().message());
  return *std::move(store);
}

/// Makes a world that was started once and holds `count` records.
std::unique_ptr<Store> filled(const std::string& place, SplitMix64& rng, std::size_t count) {
  auto store = created(place);
  REQUIRE(store->raise_epoch().has_value());
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE(store->append(players, sample_records(rng, 1, 1, count)).has_value());
  return store;
}

std::vector<EditRecord> log_of(Store& store, Sequence first = 1, Sequence last = ~Sequence{0}) {
  std::vector<EditRecord> records;
  const auto read = store.read_log(first, last, [&](const EditRecord& record) {
    records.push_back(record);
    return true;
  });
  if (!read) FAIL(read.error().message());
  return records;
}

}  // namespace

TEST_CASE("a new world opens again with everything that creation pinned", "[store]") {
  TempPlace place;
  const std::string world = place / "a/b";
  created(world);
  const auto store = opened(world);
  const WorldMeta expected = sample_meta();
  CHECK(store->file() == file_of(world));
  CHECK(store->meta().world_id == expected.world_id);
  CHECK(store->meta().chunk_edge == expected.chunk_edge);
  CHECK(store->meta().generator == expected.generator);
  CHECK(store->meta().materials == expected.materials);
  CHECK(store->meta().server_key_seed == expected.server_key_seed);
  CHECK(store->meta().spawn == expected.spawn);
  CHECK(store->epoch() == 0);
  CHECK(*store->last_sequence() == 0);
  CHECK(*store->checkpoint() == 0);
  CHECK(store->players()->empty());
  CHECK(store->high_waters()->empty());
  CHECK(store->snapshot_keys()->empty());
  CHECK(store->check().has_value());
}

TEST_CASE("the epoch rises by one at each start and stays", "[store]") {
  TempPlace place;
  CHECK(*created(place.path())->raise_epoch() == 1);
  CHECK(*opened(place.path())->raise_epoch() == 2);
  CHECK(opened(place.path())->epoch() == 2);
}

TEST_CASE("records, players and marks come back as they were appended", "[store]") {
  TempPlace place;
  SplitMix64 rng(1);
  const auto first = sample_records(rng, 1, 1, 40);
  const auto second = sample_records(rng, 2, 41, 25);
  {
    auto store = created(place.path());
    REQUIRE(*store->raise_epoch() == 1);
    const std::vector<PlayerRow> players = {sample_player(2), sample_player(1)};
    REQUIRE(store->append(players, first).has_value());
    CHECK(log_of(*store) == first);
  }
  auto store = opened(place.path());
  REQUIRE(*store->raise_epoch() == 2);
  PlayerRow renamed = sample_player(1);
  renamed.name = "new name";
  REQUIRE(store->append({&renamed, 1}, second).has_value());
  CHECK(*store->last_sequence() == 65);
  CHECK(log_of(*store, 41, 65) == second);
  CHECK(log_of(*store, 7, 9) == std::vector<EditRecord>(first.begin() + 6, first.begin() + 9));
  CHECK(log_of(*store, 66, 99).empty());
  CHECK(log_of(*store).size() == 65);

  const auto players = store->players();
  REQUIRE(players->size() == 2);
  CHECK((*players)[0].author == 1);
  CHECK((*players)[0].name == "new name");
  CHECK((*players)[0].key == sample_player(1).key);
  CHECK((*players)[1].name == "builder 2");

  std::map<std::pair<AuthorId, ClientInstance>, HighWater> expected;
  for (const auto* batch : {&first, &second}) {
    for (const EditRecord& record : *batch) {
      auto& mark = expected[{record.op.author, record.op.instance}];
      mark.resolved = std::max(mark.resolved, record.op.seq);
      mark.last_us = std::max(mark.last_us, record.time_us);
    }
  }
  const auto marks = store->high_waters();
  REQUIRE(marks->size() == expected.size());
  for (const HighWater& mark : *marks) {
    CHECK(mark.resolved == expected[{mark.author, mark.instance}].resolved);
    CHECK(mark.last_us == expected[{mark.author, mark.instance}].last_us);
  }
  CHECK(store->check().has_value());
}

TEST_CASE("the last 16 names of each player are kept in the order of their first use", "[store]") {
  TempPlace place;
  const auto text_of_names = [](Store& store) {
    std::string text;
    const auto names = store.player_names();
    REQUIRE(names.has_value());
    for (const UsedName& name : *names) text += std::to_string(name.author) + " " + name.name + ";";
    return text;
  };
  const auto rename = [](Store& store, AuthorId author, const std::string& name) {
    PlayerRow row = sample_player(author);
    row.name = name;
    REQUIRE(store.append({&row, 1}, {}).has_value());
  };
  {
    auto store = created(place.path());
    REQUIRE(store->raise_epoch().has_value());
    for (const char* name : {"ana", "mole", "ana"}) rename(*store, 7, name);
    rename(*store, 3, "ana");
    CHECK(text_of_names(*store) == "3 ana;7 ana;7 mole;");
    for (int i = 1; i <= 15; ++i) rename(*store, 7, "n" + std::to_string(i));
  }
  auto store = opened(place.path());
  const std::string after = text_of_names(*store);
  CHECK(after.starts_with("3 ana;7 mole;7 n1;7 n2;"));
  CHECK(after.ends_with("7 n14;7 n15;"));
  CHECK(store->player_names()->size() == 17);
  CHECK(store->check().has_value());
}

TEST_CASE("a mark never falls when an older client sequence is logged later", "[store]") {
  TempPlace place;
  SplitMix64 rng(2);
  auto store = created(place.path());
  REQUIRE(store->raise_epoch().has_value());
  auto records = sample_records(rng, 1, 1, 2);
  records[0].op = {1, 5, 90};
  records[1].op = {1, 5, 70};
  REQUIRE(store->append({}, {records.data(), 1}).has_value());
  REQUIRE(store->append({}, {records.data() + 1, 1}).has_value());
  REQUIRE(store->high_waters()->size() == 1);
  CHECK(store->high_waters()->front().resolved == 90);
  CHECK(store->high_waters()->front().last_us ==
        records[1].time_us);  // the time rises although the sequence does not
}

TEST_CASE("a read of the log stops when its callback returns false, and may be nested", "[store]") {
  TempPlace place;
  SplitMix64 rng(3);
  auto store = filled(place.path(), rng, 10);
  std::size_t outer = 0, inner = 0;
  REQUIRE(store
              ->read_log(1, 10,
                         [&](const EditRecord&) {
                           inner += log_of(*store, 3, 4).size();
                           return ++outer < 4;
                         })
              .has_value());
  CHECK(outer == 4);
  CHECK(inner == 8);
}

TEST_CASE("a batch that does not continue the log changes nothing", "[store]") {
  TempPlace place;
  SplitMix64 rng(4);
  auto store = filled(place.path(), rng, 5);
  const auto refused = [&](std::vector<EditRecord> records) {
    const PlayerRow player = sample_player(9);
    const auto result = store->append({&player, 1}, records);
    return !result && result.error().kind == StoreError::Kind::bad_request;
  };
  CHECK(refused(sample_records(rng, 1, 7, 2)));  // a gap before it
  CHECK(refused(sample_records(rng, 1, 5, 2)));  // a sequence that exists
  CHECK(refused(sample_records(rng, 2, 6, 1)));  // an epoch that has not begun
  CHECK(refused(sample_records(rng, 0, 6, 1)));  // an epoch that is over
  auto broken = sample_records(rng, 1, 6, 3);
  broken[2].version.seq = 9;
  CHECK(refused(broken));  // a gap inside
  const PlayerRow server = sample_player(0);
  CHECK(store->append({&server, 1}, {}).error().where == "player author=0");
  CHECK(*store->last_sequence() == 5);
  CHECK(store->players()->size() == 2);
  CHECK(store->append({}, sample_records(rng, 1, 6, 1)).has_value());
}

TEST_CASE("a player whose key is taken is refused, and the store goes on", "[store]") {
  TempPlace place;
  SplitMix64 rng(14);
  auto store = filled(place.path(), rng, 5);
  PlayerRow twin = sample_player(7);
  twin.key = sample_player(1).key;
  const auto records = sample_records(rng, 1, 6, 4);
  const auto refused = store->append({&twin, 1}, records);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().kind == StoreError::Kind::bad_request);
  CHECK(*store->last_sequence() == 5);
  CHECK(store->check().has_value());
  REQUIRE(store->append({}, records).has_value());
  CHECK(*store->last_sequence() == 9);
  CHECK(store->check().has_value());
}

TEST_CASE("a record with numbers that no log can hold is refused", "[store]") {
  TempPlace place;
  SplitMix64 rng(11);
  auto store = filled(place.path(), rng, 5);
  const auto reason = [&](const auto& spoil) {
    auto records = sample_records(rng, 1, 6, 2);
    spoil(records[1]);
    const auto result = store->append({}, records);
    if (result || result.error().kind != StoreError::Kind::bad_request)
      return std::string("not refused");
    return result.error().where + " " + result.error().what;
  };
  CHECK(reason([](EditRecord& record) { record.op.seq = kSequenceMax + 1; }) ==
        "edit_log seq=7 client sequence exceeds 63 bits");
  CHECK(reason([](EditRecord& record) { record.op.seq = ~ClientSequence{0}; }) ==
        "edit_log seq=7 client sequence exceeds 63 bits");
  CHECK(reason([](EditRecord& record) { record.subject = 7; }) ==
        "edit_log seq=7 subject is not an earlier edit");
  CHECK(reason([](EditRecord& record) { record.log = 1; }) ==
        "edit_log seq=7 belongs to another log");
  CHECK(*store->last_sequence() == 5);
  auto largest = sample_records(rng, 1, 6, 1);
  largest[0].op.seq = kSequenceMax;
  REQUIRE(store->append({}, largest).has_value());
  CHECK(log_of(*store, 6).front() == largest[0]);
  CHECK(store->check().has_value());
}

TEST_CASE("snapshots replace each other and move the checkpoint", "[store]") {
  TempPlace place;
  SplitMix64 rng(5);
  const ChunkKey a{0, {1, 0, -3}}, b{2, {-7, 4, 9}};
  const ChunkPtr a1 = sample_chunk(rng, {1, 3}), a2 = sample_chunk(rng, {1, 8}),
                 b1 = sample_chunk(rng, {1, 5});
  {
    auto store = filled(place.path(), rng, 10);
    const std::vector<std::pair<ChunkKey, ChunkPtr>> first = {{a, a1}, {b, b1}};
    REQUIRE(store->save_snapshots(first, std::nullopt).has_value());
    CHECK(*store->checkpoint() == 0);
    const std::vector<std::pair<ChunkKey, ChunkPtr>> second = {{a, a2}};
    REQUIRE(store->save_snapshots(second, 8).has_value());
    REQUIRE(store->save_snapshots(second, 8).has_value());
    REQUIRE(store->save_snapshots({}, 9).has_value());
  }
  auto store = opened(place.path());
  CHECK(*store->checkpoint() == 9);
  const auto chunk = store->load_snapshot(a);
  REQUIRE(chunk->has_value());
  CHECK((*chunk)->voxels == a2->voxels);
  CHECK((*chunk)->version == a2->version);
  CHECK((*chunk)->digest == a2->digest);
  CHECK((*store->load_snapshot(b))->voxels == b1->voxels);
  CHECK_FALSE(store->load_snapshot({0, {-7, 4, 9}})->has_value());
  CHECK_FALSE(store->load_base(a)->has_value());
  const auto keys = store->snapshot_keys();
  REQUIRE(keys->size() == 2);
  CHECK((*keys)[0] == std::pair{a, Version{1, 8}});
  CHECK((*keys)[1] == std::pair{b, Version{1, 5}});
  CHECK(store->check().has_value());
}

TEST_CASE("a snapshot that would harm the world is refused and nothing of its job is kept",
          "[store]") {
  TempPlace place;
  SplitMix64 rng(6);
  auto store = filled(place.path(), rng, 10);
  const ChunkKey key{0, {1, 2, 3}}, other{0, {4, 5, 6}};
  const auto where_refused = [&](const Chunk& chunk, std::optional<Sequence> checkpoint) {
    const std::vector<std::pair<ChunkKey, ChunkPtr>> chunks = {
        {other, sample_chunk(rng, {1, 1})}, {key, std::make_shared<const Chunk>(chunk)}};
    const auto saved = store->save_snapshots(chunks, checkpoint);
    if (saved || saved.error().kind != StoreError::Kind::bad_request)
      return std::string("not refused");
    return saved.error().where;
  };
  Chunk chunk = *sample_chunk(rng, {1, 11});
  CHECK(where_refused(chunk, {}) == "snapshot chunk=1,2,3");  // not durable yet
  chunk.version = {1, 10};
  CHECK(where_refused(chunk, 11) == "meta key=checkpoint");  // ahead of the log
  Chunk drifted = chunk;
  drifted.digest.lane[1] ^= 1;
  CHECK(where_refused(drifted, {}) == "snapshot chunk=1,2,3");
  Chunk small = chunk;
  small.voxels = uniform_chunk(Extent::cube(8), 1);
  small.digest = digest_of(small.voxels);
  CHECK(where_refused(small, {}) == "snapshot chunk=1,2,3");
  CHECK(store->snapshot_keys()->empty());

  const std::vector<std::pair<ChunkKey, ChunkPtr>> good = {
      {key, std::make_shared<const Chunk>(chunk)}};
  REQUIRE(store->save_snapshots(good, 10).has_value());
  chunk.version = {1, 9};
  CHECK(where_refused(chunk, {}) == "snapshot chunk=1,2,3");  // older than the stored one
  chunk.version = {1, 10};
  CHECK(where_refused(chunk, 9) == "meta key=checkpoint");  // backwards
  CHECK(store->snapshot_keys()->size() == 1);
}

TEST_CASE("base chunks are taken once, and only while the log is empty", "[store]") {
  TempPlace place;
  SplitMix64 rng(7);
  auto store = created(place.path());
  const ChunkKey a{0, {0, -1, 5}}, b{0, {0, 0, 0}};
  const std::vector<std::pair<ChunkKey, ChunkPtr>> chunks = {{b, sample_chunk(rng, {})},
                                                             {a, sample_chunk(rng, {})}};
  REQUIRE(store->save_base(chunks).has_value());
  CHECK((*store->load_base(a))->voxels == chunks[1].second->voxels);
  CHECK((*store->load_base(a))->version == Version{});
  CHECK((*store->load_base(b))->voxels == chunks[0].second->voxels);
  CHECK(store->save_base({chunks.data(), 1}).error().kind ==
        StoreError::Kind::bad_request);  // twice
  const std::vector<std::pair<ChunkKey, ChunkPtr>> edited = {
      {{0, {9, 9, 9}}, sample_chunk(rng, {1, 1})}};
  CHECK(store->save_base(edited).error().where == "base chunk=9,9,9");
  REQUIRE(store->raise_epoch().has_value());
  REQUIRE(store->append({}, sample_records(rng, 1, 1, 1)).has_value());
  const std::vector<std::pair<ChunkKey, ChunkPtr>> late = {{{0, {8, 8, 8}}, sample_chunk(rng, {})}};
  CHECK(store->save_base(late).error().kind == StoreError::Kind::bad_request);
  CHECK_FALSE(store->load_base(edited[0].first)->has_value());
  CHECK_FALSE(store->load_base(late[0].first)->has_value());
  CHECK(store->check().has_value());
}

TEST_CASE("a second writer is refused while readers come and go", "[store]") {
  TempPlace place;
  SplitMix64 rng(8);
  auto writer = filled(place.path(), rng, 3);
  const auto second = open_world(place.path(), StoreAccess::read_write);
  REQUIRE_FALSE(second.has_value());
  CHECK(second.error().kind == StoreError::Kind::locked);
  CHECK(second.error().message().starts_with(file_of(place.path()) +
                                             ": another program is writing this world"));

  auto reader = opened(place.path(), StoreAccess::read_only);
  CHECK(*reader->last_sequence() == 3);
  REQUIRE(writer->append({}, sample_records(rng, 1, 4, 2)).has_value());
  CHECK(*reader->last_sequence() == 5);
  CHECK(log_of(*reader).size() == 5);
  CHECK(reader->append({}, sample_records(rng, 1, 6, 1)).error().kind ==
        StoreError::Kind::bad_request);
  CHECK(reader->raise_epoch().error().kind == StoreError::Kind::bad_request);
  CHECK(reader->save_snapshots({}, 1).error().kind == StoreError::Kind::bad_request);
  writer.reset();
  CHECK(*reader->last_sequence() == 5);
  CHECK(open_world(place.path(), StoreAccess::read_write).has_value());
}

TEST_CASE("a write that another program blocks is reported and works later", "[store][sqlite]") {
  TempPlace place;
  SplitMix64 rng(9);
  auto store = filled(place.path(), rng, 3);
  // Another connection holds the write lock longer than the store waits.
  sqlite3* other = nullptr;
  REQUIRE(sqlite3_open((place / "world.sqlite").c_str(), &other) == SQLITE_OK);
  REQUIRE(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr) == SQLITE_OK);
  const auto blocked = store->append({}, sample_records(rng, 1, 4, 1));
  CHECK(blocked.error().kind == StoreError::Kind::locked);
  CHECK(sqlite3_exec(other, "ROLLBACK", nullptr, nullptr, nullptr) == SQLITE_OK);
  sqlite3_close(other);
  CHECK(store->append({}, sample_records(rng, 1, 4, 1)).has_value());
}

TEST_CASE("a single-voxel edit costs at most 120 bytes of database", "[store][sqlite]") {
  TempPlace place;
  SplitMix64 rng(10);
  std::string file;
  const auto bytes_of_file = [&] {
    return std::stol(
        raw_sql(file, "SELECT page_count * page_size FROM pragma_page_count, pragma_page_size"));
  };
  long before = 0;
  constexpr Sequence kEdits = 20'000;
  {
    auto store = filled(place.path(), rng, 1);
    file = store->file();
    before = bytes_of_file();
    for (Sequence seq = 2; seq < 2 + kEdits; seq += 100) {
      auto records = sample_records(rng, 1, seq, 100);
      for (EditRecord& record : records) {
        record.edit = {
            SetVoxel{{rng.between(-2000, 2000), rng.between(0, 120), rng.between(-2000, 2000)}},
            {},
            1};
        record.cause = Cause::player;
        // Instances are random numbers of full width, of few client processes.
        record.op.instance = mix64(rng.below(8));
      }
      REQUIRE(store->append({}, records).has_value());
    }
  }
  const double bytes = static_cast<double>(bytes_of_file() - before) / kEdits;
  CAPTURE(bytes);
  CHECK(bytes < 120);
  CHECK(bytes > 40);  // less than the payload would mean that nothing was measured
}

TEST_CASE("an error message names file, place and cause in one line", "[store]") {
  CHECK(
      StoreError{StoreError::Kind::corrupt, "w/world.sqlite", "edit_log seq=7", "checksum is wrong"}
          .message() == "w/world.sqlite: edit_log seq=7: checksum is wrong");
  CHECK(StoreError{StoreError::Kind::io, "w/world.sqlite", "", "disk full"}.message() ==
        "w/world.sqlite: disk full");
}
