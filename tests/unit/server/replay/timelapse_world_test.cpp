// The part of a world that a timelapse shows, compared with the dense oracle moment by moment.
#include "server/replay/timelapse_world.hpp"

#include <catch2/catch.hpp>

#include "tests/support/core/temp_folder.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr std::int32_t kEdge = kSampleEdge;
constexpr Sequence kEdits = 120;
constexpr ChunkKey kImported{0, {2, 0, 0}};  // no edit reaches it

struct Grown {
  TempFolder folder;
  std::vector<EditRecord> records;  // record i has sequence i + 1
  std::unique_ptr<Store> store;
  std::unique_ptr<Generator> generator;

  explicit Grown(std::uint64_t seed, bool imports = false) {
    SplitMix64 rng(seed);
    WorldMeta meta = sample_meta();
    meta.generator.name = imports ? "empty" : "flat";
    store = *create_world(folder.path(), meta);
    generator = *make_generator(meta.generator, meta.materials);
    if (imports) {
      REQUIRE(store
                  ->save_base(std::vector<std::pair<ChunkKey, ChunkPtr>>{
                      {kImported, sample_chunk(rng, {})}})
                  .has_value());
    }
    records = sample_records(rng, 1, 1, kEdits);
    for (EditRecord& record : records) record.edit = random_edit_near(rng, {}, Extent::cube(kEdge));
    REQUIRE(store->raise_epoch().has_value());
    REQUIRE(store->append_history({}, records).has_value());
  }
  TimelapseWorld open(Sequence from, Sequence to, std::uint32_t radius = 1,
                      std::span<const ChunkCoord> eyes = {}) {
    auto world = TimelapseWorld::open(*store, *generator, from, to, radius, eyes);
    if (!world) FAIL(world.error().message());
    return *std::move(world);
  }
};

/// The chunks of a program that draws.
struct Drawn {
  std::map<ChunkKey, RunChunk> chunks;
  std::size_t taken = 0;
  TimelapseWorld::Each each = [this](const ChunkKey& key, const RunChunk& voxels) {
    chunks.insert_or_assign(key, voxels);
    ++taken;
    return true;
  };
  DenseChunk at(const ChunkKey& key) const {
    const auto found = chunks.find(key);
    return found == chunks.end() ? DenseChunk(Extent::cube(kEdge)) : DenseChunk::of(found->second);
  }
};

/// Returns the chunks that the edits touch, and their neighbours.
std::vector<ChunkKey> near() {
  std::vector<ChunkKey> keys;
  for (int i = 0; i < 27; ++i) keys.push_back({0, {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}});
  return keys;
}

void compare(const Grown& grown, const Drawn& held, Sequence seq) {
  for (const ChunkKey& key : near()) {
    const VoxelPos origin = origin_of(key.at, kEdge);
    DenseChunk dense = DenseChunk::of(grown.generator->generate(origin, Extent::cube(kEdge)));
    for (Sequence i = 0; i < seq; ++i) oracle_apply(dense, origin, {&grown.records[i].edit, 1});
    CAPTURE(seq, key.at.x, key.at.y, key.at.z);
    REQUIRE(held.at(key) == dense);
  }
}

}  // namespace

TEST_CASE("the chunks of a timelapse world are those of the world at each moment", "[server]") {
  Grown grown(1);
  const Sequence from = GENERATE(Sequence{0}, Sequence{40});
  TimelapseWorld world = grown.open(from, kEdits);
  Drawn held;
  REQUIRE(world.begin(held.each).has_value());
  compare(grown, held, from);
  for (const Sequence seq : {from + 1, from + 3, from + 70, kEdits}) {
    REQUIRE(world.advance(seq, held.each).has_value());
    compare(grown, held, seq);
  }
  const std::size_t taken = held.taken;
  REQUIRE(world.advance(kEdits, held.each).has_value());
  CHECK(held.taken == taken);  // nothing changed since
}

TEST_CASE("the stage holds all edits and the ground around them", "[server]") {
  Grown grown(2);
  const TimelapseWorld narrow = grown.open(0, kEdits, 0), wide = grown.open(0, kEdits, 4);
  VoxelBox edits;
  for (const EditRecord& record : grown.records) {
    const VoxelBox box = bounding_box(record.edit);
    edits = edits.empty()
                ? box
                : VoxelBox{{std::min(edits.min.x, box.min.x), std::min(edits.min.y, box.min.y),
                            std::min(edits.min.z, box.min.z)},
                           {std::max(edits.max.x, box.max.x), std::max(edits.max.y, box.max.y),
                            std::max(edits.max.z, box.max.z)}};
  }
  CHECK(narrow.edited() == edits);
  CHECK(intersect(narrow.stage(), edits) == edits);
  CHECK(wide.stage().max.x >= edits.max.x + 3 * kEdge);
  CHECK(wide.stage().min.z <= edits.min.z - 3 * kEdge);
  CHECK(wide.chunk_count() > narrow.chunk_count());
  // The chunk with the surface is on the stage, although it is far from every edit.
  Drawn held;
  TimelapseWorld world = grown.open(0, kEdits, 4);
  REQUIRE(world.begin(held.each).has_value());
  const std::int32_t x = floor_div(edits.max.x, kEdge) + 3;
  const std::int32_t y = floor_div(grown.generator->surface_y(x * kEdge, 0) - 1, kEdge);
  CHECK(held.chunks.contains({0, {x, y, 0}}));
}

TEST_CASE("protected ground does not widen the stage", "[server]") {
  Grown grown(7);
  EditRecord record = grown.records.back();
  ++record.version.seq;
  ++record.op.seq;
  record.cause = Cause::rights;
  record.subject = 0;
  ProtectedBox box;
  box.name = "spawn";
  box.box = {{-16, -kWorldLimit, -16}, {16, kWorldLimit, 16}};
  record.edit = rights_edit(Protect{box});
  REQUIRE(grown.store->append_history({}, std::vector{record}).has_value());
  const TimelapseWorld before = grown.open(0, kEdits), after = grown.open(0, kEdits + 1);
  CHECK(after.edited() == before.edited());
  CHECK(after.stage() == before.stage());
}

TEST_CASE("the stage has the ground around the camera", "[server]") {
  Grown grown(3);
  const std::vector<ChunkCoord> eyes = {{100, 7, 100}};
  const TimelapseWorld world = grown.open(0, kEdits, 1, eyes);
  CHECK(world.stage().max.x == 102 * kEdge);
}

TEST_CASE("the stage has the ground of an imported world", "[server]") {
  Grown grown(4, true);
  TimelapseWorld world = grown.open(0, 1, 3);
  Drawn held;
  REQUIRE(world.begin(held.each).has_value());
  CHECK(held.chunks.contains(kImported));
}

TEST_CASE("a timelapse without edits shows what was edited before", "[server]") {
  Grown grown(5);
  TimelapseWorld world = grown.open(kEdits, kEdits);
  CHECK_FALSE(world.edited().empty());
  Drawn held;
  REQUIRE(world.begin(held.each).has_value());
  compare(grown, held, kEdits);
}

TEST_CASE("a stage of too many chunks is rejected", "[server]") {
  Grown grown(6);
  std::vector<ChunkCoord> eyes;
  for (std::int32_t i = 0; i < 40; ++i) eyes.push_back({i * 100, 0, 0});
  const auto world = TimelapseWorld::open(*grown.store, *grown.generator, 0, kEdits, 32, eyes);
  REQUIRE_FALSE(world.has_value());
  CHECK(world.error().what.find("--radius") != std::string::npos);
}
