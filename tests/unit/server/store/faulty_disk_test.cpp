// A world is made, written, compacted and repaired while every call of the system under SQLite fails,
// once or from then on. After each error nothing durable is lost, nothing that is half done is taken for
// done, and the error says why. To save time, each call meets one of the ten errors.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/core/digest.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"
#include "tests/unit/server/store/faulty_writer.hpp"

namespace runstone::test {
namespace {

namespace fs = std::filesystem;
using KeyedChunkPtrs = std::vector<std::pair<ChunkKey, ChunkPtr>>;

constexpr std::uint64_t kEveryTenth = 10;
constexpr Sequence kRichEdits = 30, kRichKeyframe = 20, kLaterEdit = 25;
constexpr TimeUs kClockAheadUs = 3'600'000'000;
constexpr ChunkKey kLaterChunk{0, {1, 0, 0}};
const std::string kFaultyVfs = FaultVfs::name();

EditRecord rich_record(Sequence seq, Epoch epoch, Cause cause, EditDescriptor edit) {
  EditRecord record;
  record.version = {epoch, seq};
  record.op = {1, 5, seq};
  record.time_us = 1'700'000'000'000'000 + static_cast<TimeUs>(seq) * 1000;
  record.cause = cause;
  record.edit = std::move(edit);
  return record;
}

EditDescriptor one_material(Material id, const std::string& name) {
  AddedMaterials added{id, {}};
  added.rows.push_back({name, {1, 2, 3, 90}, Visibility::transparent});
  return materials_edit(std::move(added));
}

/// Returns edits with changes of rights, new materials, and a clock that was ahead and is corrected.
std::vector<EditRecord> rich_records(Epoch epoch, Sequence first, Material next_material) {
  SplitMix64 rng(21);
  auto records = sample_records(rng, epoch, first, kRichEdits);
  const auto put = [&](std::size_t at, Cause cause, EditDescriptor edit) {
    records[at] = rich_record(first + at, epoch, cause, std::move(edit));
  };
  put(2, Cause::rights, sample_rights_edit(rng));
  put(4, Cause::materials, one_material(next_material, "lime" + std::to_string(first)));
  for (const std::size_t at : {8U, 9U}) records[at].time_us += kClockAheadUs;
  put(10, Cause::rights, rights_edit(CorrectTime{kClockAheadUs}));
  put(22, Cause::rights, sample_rights_edit(rng));
  put(24, Cause::materials,
      one_material(static_cast<Material>(next_material + 1), "teal" + std::to_string(first)));
  return records;
}

std::vector<EditRecord> all_records(Store& store) {
  std::vector<EditRecord> found;
  const auto read = store.read_log(1, kSequenceMax, [&](const EditRecord& record) {
    found.push_back(record);
    return true;
  });
  if (!read) FAIL(read.error().message());
  return found;
}

std::vector<EditRecord> rights_records(Store& store) {
  std::vector<EditRecord> found;
  const auto read = store.read_rights([&](const EditRecord& record) {
    found.push_back(record);
    return true;
  });
  if (!read) FAIL(read.error().message());
  return found;
}

KeyedChunkPtrs chunks_at(SplitMix64& rng, Version version, std::int32_t count) {
  KeyedChunkPtrs chunks;
  for (std::int32_t x = 0; x < count; ++x)
    chunks.emplace_back(ChunkKey{0, {x, 0, 0}}, sample_chunk(rng, version));
  return chunks;
}

Keyframe keyframe_of(const EditRecord& last, const KeyedChunkPtrs& chunks) {
  Keyframe keyframe{{last.version, last.time_us}, chunks.size(), {}};
  for (const auto& [key, chunk] : chunks)
    keyframe.world_digest = keyframe.world_digest + world_digest_term(key, chunk->digest);
  return keyframe;
}

/// A closed world with rows in every table: edits, rights, materials, an era, players, names, a base, an
/// older and a newer snapshot, tiles, and a keyframe in the middle of its log.
class RichWorld {
 public:
  RichWorld() {
    SplitMix64 rng(22);
    const auto store = *create_world(path(), sample_meta());
    REQUIRE(store->save_base(chunks_at(rng, {}, 2)).has_value());
    REQUIRE(store->raise_epoch().has_value());
    const auto first = static_cast<Material>(store->meta().materials.size());
    records = rich_records(1, 1, first);
    const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
    REQUIRE(store->append(players, records).has_value());
    const NameChange name{{"ana", "Ana", sample_player(1).key}, false};
    REQUIRE(store->change_names({&name, 1}).has_value());
    auto snapshots = chunks_at(rng, {1, 10}, 2);
    later = snapshots[1].second = sample_chunk(rng, {1, kLaterEdit});
    REQUIRE(store->save_snapshots(snapshots, 10).has_value());
    const KeyedChunkPtrs tiles = {{{1, {0, 0, 0}}, sample_chunk(rng, {1, kLaterEdit})}};
    REQUIRE(store->save_tiles(tiles, kTileRules).has_value());
    const auto chunks = chunks_at(rng, {1, 15}, 3);
    REQUIRE(
        store->save_keyframe(chunks, keyframe_of(records[kRichKeyframe - 1], chunks)).has_value());
    materials = *store->materials();
    rights = rights_records(*store);
    moment = store->stored_moment(kRichKeyframe)->chunks;
    REQUIRE(store->check().has_value());
  }
  std::string path() const { return folder_ / "world"; }

  std::vector<EditRecord> records, rights;
  MaterialTable materials;
  std::vector<StoredChunk> moment;  // at the keyframe
  ChunkPtr later;                   // the snapshot of kLaterChunk, which is newer than the keyframe

 private:
  TempFolder folder_;
};

/// Returns the names, versions and digests of chunks.
std::vector<std::tuple<ChunkKey, Version, Digest>> identities(
    const std::vector<StoredChunk>& chunks) {
  std::vector<std::tuple<ChunkKey, Version, Digest>> all;
  for (const StoredChunk& chunk : chunks) all.emplace_back(chunk.key, chunk.version, chunk.digest);
  return all;
}

/// Opens a world on the faulty disk. Returns null, after a check of the error, if that fails.
std::unique_ptr<Store> opened_on(FaultyWriter& writer, const std::string& place,
                                 StoreAccess access = StoreAccess::read_write) {
  auto store = open_sqlite_world(place, access, {kFaultyVfs, true});
  if (store) return *std::move(store);
  writer.check(store.error());
  return nullptr;
}

/// Calls `work(store, writer)` on copies of a world with every fault, and then `check(store, place)`
/// without.
template <class Work, class Check>
void work_on_faulty_disks(const std::string& world, std::uint64_t stride, const Work& work,
                          const Check& check) {
  const std::uint64_t runs = meet_disk_faults(stride, [&](FaultVfs& vfs, const DiskFault& fault) {
    const TempFolder run;
    const std::string copy = run / "world";
    fs::copy(world, copy);
    FaultyWriter writer(vfs, fault);
    auto done = work(copy, writer);
    vfs.heal();
    check(*sound_world(copy), done);
  });
  CHECK(runs > 50);
}

}  // namespace

TEST_CASE("an error of the disk while a world is made leaves none or a whole one, and says why",
          "[store][sqlite][faults]") {
  const std::uint64_t runs =
      meet_disk_faults(kEveryTenth, [](FaultVfs& vfs, const DiskFault& fault) {
        const TempFolder folder;
        const std::string place = folder / "world";
        FaultyWriter writer(vfs, fault);
        bool is_made = false;
        {
          const auto made = create_sqlite_world(place, sample_meta(), {kFaultyVfs, true});
          is_made = made.has_value();
          if (!made) writer.check(made.error());
          if (made) writer.does([&] { return (*made)->raise_epoch(); });
        }
        vfs.heal();
        std::string why;
        {
          const auto found = open_world(place, StoreAccess::read_write);
          if (!found) why = found.error().message();
          if (!found) CHECK(found.error().kind == StoreError::Kind::not_a_world);
        }
        INFO(why);
        if (why.empty() || is_made) {
          const auto store = sound_world(place);
          CHECK(*store->last_sequence() == 0);
          CHECK(*store->materials() == sample_meta().materials);
          return;
        }
        const bool names_way_on =
            why.ends_with("is not there") || why.ends_with("delete it and create the world again");
        CHECK(names_way_on);
      });
  CHECK(runs > 50);
}

TEST_CASE("an error of the disk loses no durable change of rights, materials or the time",
          "[store][sqlite][faults]") {
  const RichWorld world;
  constexpr std::size_t kBatch = 6;
  const auto next = static_cast<Material>(world.materials.size());
  const auto work = [&](const std::string& place, FaultyWriter& writer) {
    auto durable = world.records;
    const auto store = opened_on(writer, place);
    if (!store || !writer.does([&] { return store->raise_epoch(); })) return durable;
    const auto more = rich_records(store->epoch(), kRichEdits + 1, next);
    for (std::size_t at = 0; at < more.size(); at += kBatch) {
      const auto batch = std::span(more).subspan(at, kBatch);
      if (!writer.does([&] { return store->append({}, batch); })) return durable;
      durable.insert(durable.end(), batch.begin(), batch.end());
    }
    if (const auto done = store->complete_file(); !done) writer.check(done.error());
    return durable;
  };
  work_on_faulty_disks(world.path(), kEveryTenth, work,
                       [&](Store& store, const std::vector<EditRecord>& durable) {
                         auto found = all_records(store);
                         REQUIRE(found.size() >= durable.size());
                         // A batch whose commit failed is there as a whole, or not at all.
                         CHECK((found.size() - durable.size()) % kBatch == 0);
                         std::vector<EditRecord> rights;
                         std::size_t materials = 0;
                         for (const EditRecord& record : found) {
                           if (record.cause == Cause::rights) rights.push_back(record);
                           materials += record.cause == Cause::materials ? 1 : 0;
                         }
                         CHECK(rights_records(store) == rights);
                         CHECK(store.materials()->size() == next - 2 + materials);
                         found.resize(durable.size());
                         CHECK(found == durable);
                       });
}

TEST_CASE("an error of the disk leaves no half snapshot, tile or keyframe",
          "[store][sqlite][faults]") {
  const RichWorld world;
  SplitMix64 rng(23);
  const auto snapshots = chunks_at(rng, {1, kRichEdits}, 4);
  const KeyedChunkPtrs tiles = {{{1, {0, 0, 0}}, sample_chunk(rng, {1, kRichEdits})},
                                {{2, {0, 0, 0}}, sample_chunk(rng, {1, kRichEdits})}};
  const auto chunks = chunks_at(rng, {1, kLaterEdit}, 3);
  const Keyframe keyframe = keyframe_of(world.records.back(), chunks);
  struct Saved {
    bool snapshots = false, tiles = false, keyframe = false;
  };
  const auto work = [&](const std::string& place, FaultyWriter& writer) {
    Saved saved;
    const auto store = opened_on(writer, place);
    if (!store || !writer.does([&] { return store->raise_epoch(); })) return saved;
    saved.snapshots = writer.does([&] { return store->save_snapshots(snapshots, kRichEdits); });
    if (!saved.snapshots) return saved;
    saved.tiles = writer.does([&] { return store->save_tiles(tiles, kTileRules); });
    if (!saved.tiles) return saved;
    saved.keyframe = writer.does([&] { return store->save_keyframe(chunks, keyframe); });
    return saved;
  };
  work_on_faulty_disks(world.path(), kEveryTenth, work, [&](Store& store, const Saved& saved) {
    CHECK(all_records(store) == world.records);
    const Sequence checkpoint = *store.checkpoint();
    CHECK((checkpoint == kRichEdits || (checkpoint == 10 && !saved.snapshots)));
    for (const auto& [key, chunk] : snapshots) {
      const auto loaded = store.load_snapshot(key);
      REQUIRE(loaded.has_value());
      CHECK((*loaded == *chunk) == (checkpoint == kRichEdits));
    }
    std::size_t tiles_there = 0;
    for (const auto& [key, tile] : tiles) {
      const auto loaded = store.load_tile(key, kTileRules);
      REQUIRE(loaded.has_value());
      tiles_there += *loaded == *tile ? 1 : 0;
    }
    CHECK((tiles_there == tiles.size() || (tiles_there == 0 && !saved.tiles)));
    const std::size_t keyframes = store.keyframes()->size();
    CHECK((keyframes == 2 || (keyframes == 1 && !saved.keyframe)));
  });
}

TEST_CASE("an error of the disk leaves a world compacted or as it was", "[store][sqlite][faults]") {
  const RichWorld world;
  const auto work = [&](const std::string& place, FaultyWriter& writer) {
    const auto store = opened_on(writer, place);
    if (!store) return false;
    const bool is_compacted = writer.does([&] { return store->compact(kRichKeyframe); });
    if (is_compacted) writer.does([&] { return store->shrink(); });
    return is_compacted;
  };
  work_on_faulty_disks(
      world.path(), kEveryTenth, work, [&](Store& store, const bool& is_compacted) {
        const Sequence first = store.log_range()->first;
        CHECK((first == kRichKeyframe + 1 || (first == 1 && !is_compacted)));
        const auto left = std::span(world.records).subspan(first - 1);
        CHECK(all_records(store) == std::vector<EditRecord>(left.begin(), left.end()));
        CHECK(rights_records(store) == world.rights);
        CHECK(*store.materials() == world.materials);
        CHECK(identities(store.stored_moment(kRichKeyframe)->chunks) == identities(world.moment));
        CHECK(store.keyframes()->size() == (first == 1 ? 1 : 0));
        CHECK(**store.load_snapshot(kLaterChunk) == *world.later);
      });
}

TEST_CASE("an error of the disk while losses are accepted leaves all of them, or none",
          "[store][sqlite][faults][loss]") {
  const RichWorld world;
  const std::string file = world.path() + "/world.sqlite";
  {
    // The mark says more than the log has, because an older file is put back.
    const std::string older = world.path() + "/older";
    fs::copy_file(file, older);
    auto store = *open_world(world.path(), StoreAccess::read_write);
    REQUIRE(store->raise_epoch().has_value());
    SplitMix64 rng(24);
    REQUIRE(store->append({}, sample_records(rng, 2, kRichEdits + 1, 5)).has_value());
    store.reset();
    fs::rename(older, file);
    raw_sql(file, "DELETE FROM player WHERE author = 2");
    raw_sql(file, "DELETE FROM player_instance");
    raw_sql(file, "DELETE FROM name_claim");
    raw_sql(file, "DELETE FROM snapshot WHERE x = 1");
    raw_sql(file, "DELETE FROM player_name WHERE author = 2");
  }
  constexpr std::size_t kLosses = 6;  // the edits, and one for each table
  const std::uint64_t runs =
      meet_disk_faults(kEveryTenth, [&](FaultVfs& vfs, const DiskFault& fault) {
        const TempFolder run;
        const std::string copy = run / "world";
        fs::copy(world.path(), copy);
        FaultyWriter writer(vfs, fault);
        bool is_accepted = false, is_started = false;
        if (const auto store = opened_on(writer, copy, StoreAccess::repair)) {
          is_accepted = writer.does([&] { return store->accept_losses(); });
          is_started = is_accepted && writer.does([&] { return store->raise_epoch(); });
        }
        vfs.heal();
        if (!is_started) {
          // A start is refused until all of it is done.
          if (const auto opened = open_world(copy, StoreAccess::read_write)) {
            CHECK(is_accepted);
          } else {
            CHECK(opened.error().kind == StoreError::Kind::corrupt);
          }
          const auto again = *open_world(copy, StoreAccess::repair);
          const auto lost = again->accept_losses();
          REQUIRE(lost.has_value());
          const bool is_whole = lost->size() == kLosses && !is_accepted;
          CHECK((is_whole || lost->size() <= 1));
          REQUIRE(again->raise_epoch().has_value());
        }
        const auto store = sound_world(copy);
        CHECK(all_records(*store) == world.records);
        CHECK(store->epoch() > 2);
      });
  CHECK(runs > 50);
}

}  // namespace runstone::test
