// Counts of plans: they equal the plans, whatever way a chunk takes.
#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/runs/reorder.hpp"
#include "server/rollback/chunk_past.hpp"
#include "server/rollback/few_voxels.hpp"
#include "server/rollback/restore_plan.hpp"
#include "server/rollback/selection.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kArea = 3 * kSampleEdge;

/// Counts the calls, and makes the chunks of another generator.
class CountingGenerator final : public Generator {
 public:
  explicit CountingGenerator(const Generator& generator) : generator_(generator) {}
  RunChunk generate(VoxelPos origin, Extent extent) const override {
    ++(extent.volume() == 1 ? voxels : chunks);
    return generator_.generate(origin, extent);
  }
  std::int32_t y_min() const override { return generator_.y_min(); }
  std::int32_t y_max() const override { return generator_.y_max(); }
  std::int32_t surface_y(std::int32_t x, std::int32_t z) const override {
    return generator_.surface_y(x, z);
  }

  mutable std::size_t voxels = 0, chunks = 0;

 private:
  const Generator& generator_;
};

/// Returns an edit of few voxels, as griefers scatter them, or seldom a large one.
EditDescriptor scattered_edit(SplitMix64& rng, std::uint32_t large_of_100) {
  if (rng.below(100) < large_of_100) return random_edit_near(rng, {0, 0, 0}, Extent::cube(kArea));
  const VoxelPos at{rng.between(0, kArea - 1), rng.between(-8, 8), rng.between(0, kArea - 1)};
  EditDescriptor edit{SetVoxel{at}, {}, static_cast<Material>(rng.below(5))};
  if (rng.below(4) == 0) {
    edit.shape = FillBox{
        {at, {at.x + rng.between(1, 4), at.y + rng.between(1, 4), at.z + rng.between(1, 4)}}};
  } else if (rng.below(8) == 0) {
    edit.shape = FillSphere{at, static_cast<std::uint16_t>(rng.below(3))};
  }
  if (rng.below(6) == 0)
    edit.mask = {MaskKind::only_material, static_cast<Material>(1 + rng.below(4))};
  if (rng.below(9) == 0) edit.mask = {MaskKind::only_empty, kEmpty};
  return edit;
}

struct CountedWorld {
  explicit CountedWorld(SplitMix64& rng, std::size_t count, std::uint32_t large_of_100) {
    WorldMeta meta = sample_meta();
    meta.generator = {"flat", 1, 0, ""};
    REQUIRE(create_world(folder.path(), meta).has_value());
    store = *open_world(folder.path(), StoreAccess::read_write);
    REQUIRE(store->raise_epoch().has_value());
    generator = *make_generator(meta.generator, meta.materials);
    for (Sequence seq = 1; seq <= count; ++seq) {
      EditRecord record = sample_record(rng, 1, seq);
      record.op.author = static_cast<AuthorId>(1 + rng.below(3));
      record.cause = rng.below(4) == 0 ? record.cause : Cause::player;
      record.subject = record.cause == Cause::player || record.cause == Cause::console ||
                               record.cause == Cause::import
                           ? 0
                           : 1 + rng.below(static_cast<std::uint32_t>(seq));
      if (record.subject >= seq) record.subject = seq - 1;
      record.edit = scattered_edit(rng, large_of_100);
      records.push_back(record);
    }
    std::vector<PlayerRow> players;
    for (AuthorId author = 1; author <= 3; ++author) players.push_back(sample_player(author));
    const auto appended = store->append(players, records);
    INFO((appended ? "" : appended.error().message()));
    REQUIRE(appended.has_value());
  }

  Sequence end() const { return records.size(); }
  /// Saves half of the chunks as they were at some moment.
  void save_some_snapshots(SplitMix64& rng) {
    ReplayScratch scratch;
    const Sequence at = 1 + rng.below(static_cast<std::uint32_t>(records.size()));
    std::set<ChunkKey> keys;
    for (const EditRecord& record : records) {
      for (const ChunkCoord& touched : touched_chunks(record.edit, kSampleEdge)) {
        if (rng.below(2) == 0) keys.insert({0, touched});
      }
    }
    std::vector<std::pair<ChunkKey, ChunkPtr>> chunks;
    for (const ChunkKey& key : keys) {
      auto chunk = chunk_past(*store, *generator, key, at, scratch);
      REQUIRE(chunk.has_value());
      REQUIRE(digest_of(chunk->voxels) == chunk->digest);
      if (chunk->version.seq != 0)
        chunks.emplace_back(key, std::make_shared<const Chunk>(*std::move(chunk)));
    }
    REQUIRE(store->save_snapshots(chunks, std::nullopt).has_value());
  }

  TempFolder folder;
  std::unique_ptr<Store> store;
  std::unique_ptr<Generator> generator;
  std::vector<EditRecord> records;
};

std::vector<RestorePlanner::Item> items_of(const Selection& selection) {
  std::vector<RestorePlanner::Item> items;
  for (const auto& [key, edits] : selection.chunks) items.push_back({key, edits});
  return items;
}

using Counts = std::vector<std::pair<ChunkKey, std::uint64_t>>;

Counts counts_of_plans(CountedWorld& world, const Selection& selection) {
  Counts out;
  RestorePlanner(*world.store, *world.generator)
      .plan_all(items_of(selection), selection.box, world.end(),
                [&](const ChunkKey& key, const StoreResult<RestorePlan>& plan) {
                  REQUIRE(plan.has_value());
                  out.emplace_back(key, plan->voxels);
                  return true;
                });
  return out;
}

}  // namespace

TEST_CASE("counts of scattered voxels are those of the plans, also behind rollbacks",
          "[rollback]") {
  SplitMix64 rng(21 + Catch::rngSeed());
  std::size_t voxels = 0, chunks = 0, changed = 0;
  for (int round = 0; round < 24; ++round) {
    const std::vector<std::uint32_t> large = {0, 1, 15};
    CountedWorld world(rng, 30 + rng.below(400),
                       large[static_cast<std::size_t>(round) % large.size()]);
    if (rng.below(2) == 0) world.save_some_snapshots(rng);
    for (int question = 0; question < 4; ++question) {
      SelectionFilter filter;
      if (question != 3) filter.authors = {static_cast<AuthorId>(1 + rng.below(3))};
      if (rng.below(2) == 0) filter.first = 1 + rng.below(static_cast<std::uint32_t>(world.end()));
      if (rng.below(3) == 0)
        filter.box = VoxelBox{{rng.between(-9, 9), -8, rng.between(-9, 9)},
                              {rng.between(12, 40), rng.between(1, 9), rng.between(12, 40)}};
      const auto selection = select_edits(*world.store, filter);
      REQUIRE(selection.has_value());
      const Counts expected = counts_of_plans(world, *selection);
      const CountingGenerator generator(*world.generator);
      Counts counts;
      RestorePlanner(*world.store, generator)
          .count_all(items_of(*selection), selection->box, world.end(),
                     [&](const ChunkKey& key, const StoreResult<std::uint64_t>& in_chunk) {
                       REQUIRE(in_chunk.has_value());
                       counts.emplace_back(key, *in_chunk);
                       return true;
                     });
      CAPTURE(Catch::rngSeed(), round, question);
      REQUIRE(counts == expected);
      voxels += generator.voxels;
      chunks += generator.chunks;
      for (const auto& [key, in_chunk] : counts) changed += in_chunk > 0 ? 1 : 0;
    }
  }
  // Both ways were taken.
  CHECK(voxels > 200);
  CHECK(chunks > 50);
  CHECK(changed > 300);
}

TEST_CASE("few voxels are those of the selected edits inside the box", "[rollback]") {
  std::vector<EditRecord> records(4);
  for (std::size_t i = 0; i < records.size(); ++i) records[i].version = {1, i + 1};
  records[0].edit = {SetVoxel{{5, 5, 5}}, {}, 1};
  records[1].edit = {FillBox{{{4, 5, 5}, {6, 6, 7}}}, {}, 2};
  records[2].edit = {SetVoxel{{9, 9, 9}}, {}, 3};
  records[3].edit = {SetVoxel{{40, 9, 9}}, {}, 3};
  std::vector<const EditRecord*> all;
  for (const EditRecord& record : records) all.push_back(&record);
  const VoxelBox chunk = box_of({0, 0, 0}, 16);
  using Voxels = std::vector<VoxelPos>;
  CHECK(few_voxels(all, std::vector<Sequence>{1, 2, 4}, chunk, 16) ==
        Voxels{{4, 5, 5}, {4, 5, 6}, {5, 5, 5}, {5, 5, 6}});
  CHECK(few_voxels(all, std::vector<Sequence>{2, 3}, {{5, 0, 0}, {9, 16, 6}}, 16) ==
        Voxels{{5, 5, 5}});
  CHECK(few_voxels(all, std::vector<Sequence>{4}, chunk, 16) == Voxels{});

  // One voxel in 32 of a chunk is few.
  records[1].edit = {FillBox{{{0, 0, 0}, {16, 8, 1}}}, {}, 2};
  CHECK(few_voxels(all, std::vector<Sequence>{2}, chunk, 16)->size() == 128);
  CHECK_FALSE(few_voxels(all, std::vector<Sequence>{1, 2}, chunk, 16).has_value());
  CHECK(few_voxels(all, std::vector<Sequence>{1, 2}, box_of({0, 0, 0}, 32), 32).has_value());
  // Large edits of others cost more for each voxel.
  std::vector<EditRecord> spheres(12);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    spheres[i].version = {1, i + 10};
    spheres[i].edit = {FillSphere{{0, 0, 0}, 5}, {}, 4};
    all.push_back(&spheres[i]);
  }
  CHECK_FALSE(few_voxels(all, std::vector<Sequence>{2}, chunk, 16).has_value());
  CHECK(few_voxels(all, std::vector<Sequence>{1}, chunk, 16) == Voxels{{5, 5, 5}});
}

TEST_CASE("a chunk that cannot be read has the only error, and the others their counts",
          "[rollback][sqlite]") {
  SplitMix64 rng(5);
  CountedWorld world(rng, 300, 0);
  ReplayScratch scratch;
  const ChunkKey bad{0, {1, 0, 1}};
  auto chunk = chunk_past(*world.store, *world.generator, bad, 100, scratch);
  REQUIRE(chunk.has_value());
  REQUIRE(chunk->version.seq > 0);
  const std::vector<std::pair<ChunkKey, ChunkPtr>> rows = {
      {bad, std::make_shared<const Chunk>(*std::move(chunk))}};
  REQUIRE(world.store->save_snapshots(rows, std::nullopt).has_value());
  SelectionFilter filter;
  filter.first = 150;
  const auto selection = select_edits(*world.store, filter);
  REQUIRE(selection.has_value());
  REQUIRE(selection->chunks.contains(bad));
  const Counts expected = counts_of_plans(world, *selection);
  REQUIRE(raw_sql(world.store->file(), "UPDATE snapshot SET data = x'0102'").empty());

  RestorePlanner planner(*world.store, *world.generator);
  std::vector<ChunkKey> errors;
  Counts counts;
  const auto each = [&](const ChunkKey& key, const StoreResult<std::uint64_t>& in_chunk) {
    if (in_chunk) {
      counts.emplace_back(key, *in_chunk);
    } else {
      CHECK(in_chunk.error().kind == StoreError::Kind::corrupt);
      CHECK(in_chunk.error().where == "snapshot chunk=1,0,1");
      errors.push_back(key);
    }
    return true;
  };
  planner.count_all(items_of(*selection), std::nullopt, world.end(), each);
  CHECK(errors == std::vector<ChunkKey>{bad});
  REQUIRE(counts.size() + 1 == expected.size());
  std::size_t i = 0;
  for (const auto& [key, in_chunk] : expected) {
    if (key != bad) CHECK(counts[i++] == std::pair(key, in_chunk));
  }
  // The caller that ends at the error gets no further chunk, and can use the planner again.
  std::size_t calls = 0;
  const auto until_error = [&](const ChunkKey&, const StoreResult<std::uint64_t>& in_chunk) {
    ++calls;
    return in_chunk.has_value();
  };
  planner.count_all(items_of(*selection), std::nullopt, world.end(), until_error);
  CHECK(calls > 0);
  CHECK(calls < expected.size());
  counts.clear();
  planner.count_all(items_of(*selection), std::nullopt, world.end(), each);
  CHECK(counts.size() + 1 == expected.size());
}

TEST_CASE("the undo of a rollback whose point is the oldest returns to it", "[rollback]") {
  TempFolder folder;
  WorldMeta meta = sample_meta();
  REQUIRE(create_world(folder.path(), meta).has_value());
  const auto store = *open_world(folder.path(), StoreAccess::read_write);
  REQUIRE(store->raise_epoch().has_value());
  const auto generator = *make_generator(meta.generator, meta.materials);
  SplitMix64 rng(3);
  std::vector<EditRecord> records;
  const auto add = [&](Cause cause, ClientInstance instance, Sequence subject, VoxelPos at,
                       Material material) {
    EditRecord record = sample_record(rng, 1, records.size() + 1);
    record.op = {1, instance, records.size() + 1};
    record.cause = cause;
    record.subject = subject;
    record.edit = {SetVoxel{at}, {}, material};
    records.push_back(record);
  };
  add(Cause::player, 1, 0, {1, 1, 1}, 7);
  // The points of 64 rollbacks are kept. The undo of the first one adds the 65th point.
  for (ClientInstance i = 0; i < 64; ++i)
    add(Cause::rollback, 100 + i, 1, i == 0 ? VoxelPos{1, 1, 1} : VoxelPos{2, 2, 2},
        i == 0 ? kEmpty : static_cast<Material>(1 + i % 2));
  add(Cause::undo, 500, 2, {1, 1, 1}, 7);
  const std::vector<PlayerRow> players = {sample_player(1)};
  REQUIRE(store->append(players, records).has_value());
  // Edit 1 is selected: the rollback and its undo are no writers, so its voxel is still its own.
  RestorePlanner planner(*store, *generator);
  const std::vector<Sequence> selected = {1};
  const auto plan = planner.plan({0, {0, 0, 0}}, selected, std::nullopt, records.size());
  REQUIRE(plan.has_value());
  CHECK(plan->voxels == 1);
  const std::vector<RestorePlanner::Item> items = {{{0, {0, 0, 0}}, selected}};
  planner.count_all(items, std::nullopt, records.size(),
                    [&](const ChunkKey&, const StoreResult<std::uint64_t>& voxels) {
                      CHECK(*voxels == 1);
                      return true;
                    });
}

}  // namespace runstone::test
