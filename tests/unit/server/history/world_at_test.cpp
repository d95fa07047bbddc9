// The world at a sequence equals the base with the edits up to it, voxel by voxel.
#include "server/history/world_at.hpp"

#include <catch2/catch.hpp>

#include "common/core/utc_text.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/compact_by_hand.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr Sequence kEdits = 200;
constexpr ChunkKey kImported{0, {1, 0, 0}};

/// The chunks around (0, 0, 0). Most edits of these tests are there.
std::vector<ChunkKey> watched() {
  std::vector<ChunkKey> keys;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) keys.push_back({0, {x, y, z}});
    }
  }
  return keys;
}

/// A world on disk, and its records for the oracle.
struct History {
  TempFolder folder;
  std::vector<EditRecord> records;  // record i has sequence i + 1
  ChunkPtr imported;
  std::unique_ptr<Store> store;
  std::unique_ptr<Generator> generator;

  explicit History(std::uint64_t seed) {
    SplitMix64 rng(seed);
    WorldMeta meta = sample_meta();
    meta.generator.name = "flat";
    store = *create_world(folder.path(), meta);
    generator = *make_generator(meta.generator, meta.materials);
    imported = sample_chunk(rng, {});
    REQUIRE(store->save_base(std::vector<std::pair<ChunkKey, ChunkPtr>>{{kImported, imported}})
                .has_value());
    records = sample_records(rng, 1, 1, kEdits);
    for (EditRecord& record : records) {
      record.edit = random_edit_near(rng, {}, Extent::cube(kSampleEdge));
      if (record.version.seq > kEdits / 2) record.version.epoch = 2;
    }
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(store->append_history({}, records).has_value());
  }

  LogEnd end(Sequence seq) const { return {records[seq - 1].version, records[seq - 1].time_us}; }

  WorldAt at(Sequence seq) {
    auto world = WorldAt::open(*store, *generator, seq);
    if (!world) FAIL(world.error().message());
    return *std::move(world);
  }

  DenseChunk base_of(const ChunkKey& key) const {
    if (key == kImported) return DenseChunk::of(imported->voxels);
    return DenseChunk::of(
        generator->generate(origin_of(key.at, kSampleEdge), Extent::cube(kSampleEdge)));
  }
};

bool oracle_touches(const EditDescriptor& edit, const VoxelBox& box) {
  for (int x = box.min.x; x < box.max.x; ++x) {
    for (int y = box.min.y; y < box.max.y; ++y) {
      for (int z = box.min.z; z < box.max.z; ++z) {
        if (oracle_covers(edit, {x, y, z})) return true;
      }
    }
  }
  return false;
}

/// Compares all watched chunks of `world` at `seq` with those that the oracle makes from base and
/// edits.
void compare(const History& history, WorldAt& world, Sequence seq) {
  CAPTURE(seq);
  REQUIRE(world.at() == seq);
  std::vector<ChunkKey> touched;
  for (const ChunkKey& key : watched()) {
    DenseChunk dense = history.base_of(key);
    Version version;
    for (Sequence i = 0; i < seq; ++i) {
      const EditRecord& record = history.records[i];
      if (!oracle_touches(record.edit, box_of(key.at, kSampleEdge))) continue;
      oracle_apply(dense, origin_of(key.at, kSampleEdge), {&record.edit, 1});
      version = record.version;
    }
    if (version != Version{}) touched.push_back(key);
    const auto chunk = world.chunk(key);
    if (!chunk) FAIL(chunk.error().message());
    CAPTURE(key.at.x, key.at.y, key.at.z);
    REQUIRE(DenseChunk::of(chunk->voxels) == dense);
    REQUIRE(chunk->digest == dense.digest());
    REQUIRE(chunk->version == version);
    REQUIRE(world.version(key) == version);
    std::uint32_t fewest = chunk->voxels.volume();
    for (int order = 0; order < kAxisOrderCount; ++order) {
      fewest = std::min(fewest, dense.run_count(static_cast<AxisOrder>(order)));
    }
    REQUIRE(chunk->voxels.runs.size() == fewest);
  }
  std::vector<ChunkKey> edited = world.edited();
  REQUIRE(std::is_sorted(edited.begin(), edited.end()));
  const auto all = watched();
  std::erase_if(edited, [&](const ChunkKey& key) {
    return std::find(all.begin(), all.end(), key) == all.end();
  });
  REQUIRE(edited == touched);
}

std::string refusal(const StoreResult<void>& result) {
  REQUIRE_FALSE(result.has_value());
  CHECK(result.error().kind == StoreError::Kind::bad_request);
  return result.error().what;
}

std::string refusal(const StoreResult<WorldAt>& result) {
  REQUIRE_FALSE(result.has_value());
  CHECK(result.error().kind == StoreError::Kind::bad_request);
  return result.error().what;
}

}  // namespace

TEST_CASE("the world at a sequence is base and edits up to it", "[history]") {
  History history(1);
  for (const Sequence seq : {Sequence{0}, Sequence{1}, Sequence{7}, Sequence{41}, kEdits}) {
    WorldAt world = history.at(seq);
    compare(history, world, seq);
  }
}

TEST_CASE("a world at a sequence can move to later ones", "[history]") {
  History history(2);
  WorldAt world = history.at(0);
  for (const Sequence seq : {Sequence{3}, Sequence{3}, Sequence{30}, Sequence{66}, kEdits}) {
    REQUIRE(world.advance(seq).has_value());
    compare(history, world, seq);
  }
}

TEST_CASE("a moment outside the log is refused, and the open one stays", "[history]") {
  History history(3);
  CHECK(refusal(WorldAt::open(*history.store, *history.generator, kEdits + 1)) ==
        "ends at seq=200, before seq=201");
  WorldAt world = history.at(20);
  CHECK(refusal(world.advance(19)) == "cannot be followed back from seq=20 to seq=19");
  CHECK(refusal(world.advance(kEdits + 1)) == "ends at seq=200, before seq=201");
  compare(history, world, 20);
  REQUIRE(world.advance(30).has_value());
  compare(history, world, 30);
}

TEST_CASE("a compacted log has the moments from its head on", "[history]") {
  History history(4);
  constexpr Sequence kHead = 50;
  std::vector<std::pair<ChunkKey, ChunkPtr>> completed;
  {
    WorldAt world = history.at(kHead);
    for (const ChunkKey& key : world.edited()) {
      completed.emplace_back(key, std::make_shared<const Chunk>(*world.chunk(key)));
    }
  }
  history.store.reset();
  compact_by_hand(history.folder / "world.sqlite", history.end(kHead), completed);
  history.store = *open_world(history.folder.path(), StoreAccess::read_only);
  for (const Sequence seq : {kHead, kHead + 1, kEdits}) {
    WorldAt world = history.at(seq);
    compare(history, world, seq);
  }
  CHECK(refusal(WorldAt::open(*history.store, *history.generator, kHead - 1)) ==
        "begins at seq=51: the world at seq=49 was removed by retention up to seq=50 (" +
            utc_text(history.end(kHead).time_us) + "), which is the earliest one left");
}

TEST_CASE("a compaction beyond the moment is an error", "[history]") {
  History history(5);
  WorldAt world = history.at(20);
  const ChunkKey key = kImported;
  const auto later = history.at(50).chunk(key);
  REQUIRE(later->version > world.version(key));
  history.store.reset();
  history.store = *open_world(history.folder.path(), StoreAccess::read_only);
  WorldAt reading = history.at(20);
  compact_by_hand(history.folder / "world.sqlite", history.end(50),
                  {{key, std::make_shared<const Chunk>(*later)}});
  const std::string compacted =
      "was shortened by retention while it was read; open the moment again";
  const auto chunk = reading.chunk(key);
  REQUIRE_FALSE(chunk.has_value());
  CHECK(chunk.error().what == compacted);
  CHECK(refusal(reading.advance(60)) == compacted);
  CHECK(reading.chunk({0, {0, 0, 0}}).has_value());  // the compaction did not touch it
}

TEST_CASE("reading the edits can be cancelled", "[history]") {
  const TempFolder folder;
  SplitMix64 rng(6);
  auto store = *create_world(folder.path(), sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  REQUIRE(store->append({}, sample_records(rng, 1, 1, 3000)).has_value());
  const auto generator = *make_generator(store->meta().generator, store->meta().materials);
  std::vector<Sequence> seen;
  const auto cancelled = WorldAt::open(*store, *generator, 3000, [&](Sequence done, Sequence last) {
    CHECK(last == 3000);
    seen.push_back(done);
    return done < 2000;
  });
  REQUIRE_FALSE(cancelled.has_value());
  CHECK(cancelled.error().kind == StoreError::Kind::cancelled);
  CHECK(seen == std::vector<Sequence>{1024, 2048});
}

TEST_CASE("a damaged edit is an error that names it", "[history][damage]") {
  History history(7);
  WorldAt world = history.at(5);
  raw_sql(history.folder / "world.sqlite",
          "UPDATE edit_log SET time_us = time_us + 1 WHERE seq = 9");
  const auto advanced = world.advance(12);
  REQUIRE_FALSE(advanced.has_value());
  CHECK(advanced.error().where == "edit_log seq=9");
  compare(history, world, 5);
  REQUIRE(world.advance(8).has_value());
  compare(history, world, 8);
}
