// Selections and plans from a world on disk, against the history of every voxel.
#include "server/rollback/restore_plan.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/rollback/chunk_past.hpp"
#include "server/rollback/restore_paste.hpp"
#include "server/rollback/selection.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

constexpr AuthorId kAuthors = 3;

/// Returns edits of three authors in a few chunks, most of them with cause player.
std::vector<EditRecord> some_records(SplitMix64& rng, std::size_t count) {
  std::vector<EditRecord> records;
  for (Sequence seq = 1; seq <= count; ++seq) {
    EditRecord record = sample_record(rng, 1, seq);
    record.op.author = static_cast<AuthorId>(1 + rng.below(kAuthors));
    if (rng.below(3) != 0) record.cause = Cause::player;
    if (record.cause == Cause::player) record.subject = 0;
    record.edit = random_edit_near(rng, {0, 0, 0}, Extent::cube(2 * kSampleEdge));
    if (rng.below(8) == 0) {  // it touches no voxel, so no plan may depend on it
      record.cause = Cause::rights;
      record.subject = 0;
      record.edit = sample_rights_edit(rng);
    }
    records.push_back(record);
  }
  return records;
}

bool answers(const SelectionFilter& filter, const EditRecord& record) {
  const bool by_author =
      filter.authors.empty() ||
      std::count(filter.authors.begin(), filter.authors.end(), record.op.author) != 0;
  return record.cause != Cause::rights && by_author && record.time_us >= filter.from_us &&
         record.time_us <= filter.until_us && (!filter.cause || *filter.cause == record.cause);
}

SelectionFilter random_filter(SplitMix64& rng, const std::vector<EditRecord>& records) {
  SelectionFilter filter;
  const auto any_time = [&] {
    return records[rng.below(static_cast<std::uint32_t>(records.size()))].time_us;
  };
  if (rng.below(3) != 0) filter.authors.push_back(static_cast<AuthorId>(1 + rng.below(kAuthors)));
  if (rng.below(4) == 0) filter.authors.push_back(static_cast<AuthorId>(1 + rng.below(kAuthors)));
  if (rng.below(2) == 0) filter.from_us = any_time();
  if (rng.below(4) == 0) filter.until_us = any_time();
  if (rng.below(3) == 0) filter.cause = Cause::player;
  if (rng.below(2) == 0) {
    const VoxelPos min{rng.between(-8, 24), rng.between(-8, 24), rng.between(-8, 24)};
    filter.box = VoxelBox{
        min, {min.x + rng.between(1, 30), min.y + rng.between(1, 30), min.z + rng.between(1, 30)}};
  }
  return filter;
}

struct World {
  explicit World(std::uint64_t seed) : rng(seed) {
    WorldMeta meta = sample_meta();
    REQUIRE(create_world(folder.path(), meta).has_value());
    store = *open_world(folder.path(), StoreAccess::read_write);
    REQUIRE(store->raise_epoch().has_value());
    records = some_records(rng, 20 + rng.below(60));
    std::vector<PlayerRow> players;
    for (AuthorId author = 1; author <= kAuthors; ++author)
      players.push_back(sample_player(author));
    REQUIRE(store->append(players, records).has_value());
    pin.name = "empty";
    generator = *make_generator(pin, meta.materials);
  }
  /// Saves some chunks as they are at some sequence, so that plans begin there.
  void save_some_snapshots() {
    std::set<ChunkKey> keys;
    for (const EditRecord& record : records) {
      for (const ChunkCoord at : touched_chunks(record.edit, kSampleEdge)) keys.insert({0, at});
    }
    ReplayScratch scratch;
    const Sequence at = 1 + rng.below(static_cast<std::uint32_t>(records.size()));
    std::vector<std::pair<ChunkKey, ChunkPtr>> chunks;
    for (const ChunkKey& key : keys) {
      if (rng.below(2) == 0) continue;
      auto chunk = chunk_past(*store, *generator, key, at, scratch);
      REQUIRE(chunk.has_value());
      if (chunk->version.seq != 0)
        chunks.emplace_back(key, std::make_shared<const Chunk>(*std::move(chunk)));
    }
    REQUIRE(store->save_snapshots(chunks, std::nullopt).has_value());
    // It also saves rows of keyframes, several of one chunk.
    for (int moment = 0; moment < 3; ++moment) {
      std::map<ChunkKey, ChunkPtr> kept;
      const Sequence then = 1 + rng.below(static_cast<std::uint32_t>(records.size()));
      for (const ChunkKey& key : keys) {
        if (rng.below(2) == 0) continue;
        auto chunk = chunk_past(*store, *generator, key, then, scratch);
        REQUIRE(chunk.has_value());
        if (chunk->version.seq != 0) kept[key] = std::make_shared<const Chunk>(*std::move(chunk));
      }
      const std::vector<std::pair<ChunkKey, ChunkPtr>> rows(kept.begin(), kept.end());
      REQUIRE(store->save_keyframe(rows, std::nullopt).has_value());
    }
  }

  SplitMix64 rng;
  TempFolder folder;
  std::unique_ptr<Store> store;
  GeneratorPin pin;
  std::unique_ptr<Generator> generator;
  std::vector<EditRecord> records;
};

/// Returns the chunk now and restored, from the writers of each voxel.
std::pair<DenseChunk, DenseChunk> by_history(const World& world, const ChunkKey& key,
                                             const std::set<Sequence>& selected,
                                             const std::optional<VoxelBox>& box) {
  const VoxelPos origin = origin_of(key.at, kSampleEdge);
  DenseChunk now(Extent::cube(kSampleEdge));
  std::map<VoxelPos, std::vector<std::pair<Sequence, Material>>> writers;
  for (const EditRecord& record : world.records) {
    const DenseChunk before = now;
    oracle_apply(now, origin, {&record.edit, 1});
    if (now == before) continue;
    for (int z = 0; z < kSampleEdge; ++z) {
      for (int y = 0; y < kSampleEdge; ++y) {
        for (int x = 0; x < kSampleEdge; ++x) {
          if (now.at(x, y, z) != before.at(x, y, z)) {
            writers[{x, y, z}].emplace_back(record.version.seq, now.at(x, y, z));
          }
        }
      }
    }
  }
  DenseChunk restored = now;
  for (const auto& [p, all] : writers) {
    if (box && !box->contains({origin.x + p.x, origin.y + p.y, origin.z + p.z})) continue;
    auto last = all.rbegin();
    while (last != all.rend() && selected.contains(last->first)) ++last;
    restored.set(p.x, p.y, p.z, last == all.rend() ? kEmpty : last->second);
  }
  return {now, restored};
}

DenseChunk pasted(const RunChunk& onto, VoxelPos origin,
                  const std::vector<EditDescriptor>& pastes) {
  DenseChunk out = DenseChunk::of(onto);
  oracle_apply(out, origin, pastes);
  return out;
}

}  // namespace

/// Requires that the plans of all chunks at once are those of each alone, and that the counts of all
/// chunks are those of their plans.
void check_plan_all(RestorePlanner& planner, const Selection& selection, Sequence end) {
  std::vector<RestorePlanner::Item> items;
  for (const auto& [key, edits] : selection.chunks) items.push_back({key, edits});
  std::vector<RestorePlan> all;
  planner.plan_all(items, selection.box, end,
                   [&](const ChunkKey& key, StoreResult<RestorePlan> plan) {
                     REQUIRE(plan.has_value());
                     REQUIRE(plan->key == key);
                     all.push_back(*std::move(plan));
                     return true;
                   });
  REQUIRE(all.size() == items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto alone = planner.plan(items[i].key, items[i].selected, selection.box, end);
    REQUIRE(alone.has_value());
    REQUIRE(all[i].key == items[i].key);
    REQUIRE(all[i].version == alone->version);
    REQUIRE(all[i].edits == alone->edits);
    REQUIRE(all[i].subject == alone->subject);
    REQUIRE(all[i].voxels == alone->voxels);
    REQUIRE(DenseChunk::of(all[i].now) == DenseChunk::of(alone->now));
    REQUIRE(DenseChunk::of(all[i].restored) == DenseChunk::of(alone->restored));
  }
  std::size_t counted = 0;
  planner.count_all(items, selection.box, end,
                    [&](const ChunkKey& key, const StoreResult<std::uint64_t>& voxels) {
                      CAPTURE(counted, key.at.x, key.at.y, key.at.z);
                      REQUIRE(voxels.has_value());
                      REQUIRE(key == items[counted].key);
                      REQUIRE(*voxels == all[counted].voxels);
                      ++counted;
                      return true;
                    });
  REQUIRE(counted == items.size());
}

TEST_CASE("plans from the log equal the history of each voxel", "[rollback]") {
  std::size_t with_box = 0, changed = 0, empty = 0;
  for (std::uint64_t seed = 1; seed <= 14; ++seed) {
    World world(seed + Catch::rngSeed());
    world.save_some_snapshots();
    RestorePlanner planner(*world.store, *world.generator);
    const Sequence end = world.records.back().version.seq;
    for (int round = 0; round < 4; ++round) {
      const SelectionFilter filter = random_filter(world.rng, world.records);
      CAPTURE(Catch::rngSeed(), seed, round);
      const auto selection = select_edits(*world.store, filter);
      REQUIRE(selection.has_value());
      std::set<Sequence> selected;
      std::map<ChunkKey, std::vector<Sequence>> expected;
      for (const EditRecord& record : world.records) {
        if (!answers(filter, record)) continue;
        for (const ChunkCoord at : touched_chunks(record.edit, kSampleEdge)) {
          if (filter.box && intersect(*filter.box, box_of(at, kSampleEdge)).empty()) continue;
          if (filter.box && intersect(*filter.box, bounding_box(record.edit)).empty()) continue;
          expected[{0, at}].push_back(record.version.seq);
          selected.insert(record.version.seq);
        }
      }
      REQUIRE(selection->chunks == expected);
      REQUIRE(selection->edits == selected.size());
      if (!selected.empty()) {
        REQUIRE(selection->first == *selected.begin());
        REQUIRE(selection->last == *selected.rbegin());
      }
      empty += selected.empty() ? 1 : 0;
      check_plan_all(planner, *selection, end);
      int looked = 0;
      for (const auto& [key, edits] : selection->chunks) {
        if (++looked > 4) break;
        const auto plan = planner.plan(key, edits, selection->box, end);
        REQUIRE(plan.has_value());
        const auto [now, restored] = by_history(world, key, selected, filter.box);
        REQUIRE(DenseChunk::of(plan->now) == now);
        REQUIRE(DenseChunk::of(plan->restored) == restored);
        REQUIRE(plan->edits == edits.size());
        REQUIRE(plan->subject == edits.back());
        with_box += filter.box ? 1 : 0;
        changed += plan->voxels > 0 ? 1 : 0;
        const VoxelPos origin = origin_of(key.at, kSampleEdge);
        const auto pastes = restore_pastes(plan->now, plan->differences, origin);
        const auto careful = careful_restore_pastes(plan->now, plan->differences, origin);
        REQUIRE(pastes.empty() == (plan->voxels == 0));
        REQUIRE(pasted(plan->now, origin, pastes) == restored);
        REQUIRE(pasted(plan->now, origin, careful) == restored);
        for (const EditDescriptor& paste : careful) {
          const auto keys = touched_chunks(paste, kSampleEdge);
          REQUIRE(keys == std::vector<ChunkCoord>{key.at});
        }
      }
    }
  }
  CHECK(with_box > 20);
  CHECK(changed > 60);
  CHECK(empty < 30);
}

TEST_CASE("plans of many chunks read scattered edits once", "[rollback]") {
  constexpr int kSide = 24;  // chunks
  TempFolder folder;
  WorldMeta meta = sample_meta();
  REQUIRE(create_world(folder.path(), meta).has_value());
  const auto store = *open_world(folder.path(), StoreAccess::read_write);
  REQUIRE(store->raise_epoch().has_value());
  SplitMix64 rng(9);
  std::vector<EditRecord> records;
  for (Sequence seq = 1; seq <= kSide * kSide; ++seq) {
    EditRecord record = sample_record(rng, 1, seq);
    record.op.author = 1;
    record.cause = Cause::player;
    record.subject = 0;
    const std::int32_t x = rng.between(0, kSide * kSampleEdge - 1);
    const std::int32_t z = rng.between(0, kSide * kSampleEdge - 1);
    record.edit = {SetVoxel{{x, 0, z}}, {}, 1};
    records.push_back(record);
  }
  const std::vector<PlayerRow> players = {sample_player(1)};
  REQUIRE(store->append(players, records).has_value());
  GeneratorPin pin;
  pin.name = "empty";
  const auto generator = *make_generator(pin, meta.materials);
  const auto selection = select_edits(*store, SelectionFilter{});
  REQUIRE(selection.has_value());
  REQUIRE(selection->chunks.size() > 300);

  std::uint64_t read = 0;
  RestorePlanner planner(*store, *generator, [&] { return ++read > 0; });
  std::vector<RestorePlanner::Item> items;
  for (const auto& [key, edits] : selection->chunks) items.push_back({key, edits});
  std::uint64_t voxels = 0;
  const auto count = [&](const ChunkKey&, const StoreResult<RestorePlan>& plan) {
    REQUIRE(plan.has_value());
    voxels += plan->voxels;
    return true;
  };
  planner.plan_all(items, std::nullopt, records.size(), count);
  // Once for each record, and for each chunk when its form is read and when it is planned.
  CHECK(read <= records.size() + 2 * items.size());
  CHECK(voxels > 500);
  check_plan_all(planner, *selection, records.size());
  planner.plan_all({}, std::nullopt, records.size(), count);
  std::uint64_t counted = 0;
  read = 0;
  planner.count_all(items, std::nullopt, records.size(),
                    [&](const ChunkKey&, const StoreResult<std::uint64_t>& in_chunk) {
                      REQUIRE(in_chunk.has_value());
                      counted += *in_chunk;
                      return true;
                    });
  CHECK(counted == voxels);
  CHECK(read <= records.size() + 2 * items.size());

  SECTION("until the result is no longer wanted") {
    int left = 40;
    RestorePlanner cancelled(*store, *generator, [&] { return left-- > 0; });
    std::size_t plans = 0;
    std::string why;
    cancelled.plan_all(items, std::nullopt, records.size(),
                       [&](const ChunkKey&, const StoreResult<RestorePlan>& plan) {
                         plans += plan ? 1 : 0;
                         if (!plan) why = plan.error().what;
                         return plan.has_value();
                       });
    CHECK(plans == 0);
    CHECK(why == "cancelled");
  }

  SECTION("until the count is no longer wanted, with one error and in any place") {
    const std::uint64_t all = read;
    for (const std::uint64_t until :
         {std::uint64_t{0}, items.size() / 2, items.size() + 10, all - items.size() / 2, all - 1}) {
      std::uint64_t asked = 0;
      RestorePlanner cancelled(*store, *generator, [&] { return asked++ < until; });
      std::size_t counts = 0;
      std::vector<std::string> errors;
      const auto each = [&](const ChunkKey&, const StoreResult<std::uint64_t>& in_chunk) {
        counts += in_chunk ? 1 : 0;
        if (!in_chunk) errors.push_back(in_chunk.error().what);
        return in_chunk.has_value();
      };
      cancelled.count_all(items, std::nullopt, records.size(), each);
      CAPTURE(until, all);
      CHECK(errors == std::vector<std::string>{"cancelled"});
      CHECK(counts < items.size());
      CHECK((counts > 0) == (until >= items.size() + records.size()));
      // The reader is free of the transaction of the look-ups.
      REQUIRE(store->begin_reads().has_value());
      REQUIRE(store->end_reads().has_value());
    }
  }
}

TEST_CASE("careful pastes leave alone what was changed since the plan", "[rollback]") {
  SplitMix64 rng(5 + Catch::rngSeed());
  for (int round = 0; round < 40; ++round) {
    const RunChunk now = random_chunk(rng, Extent::cube(16), random_order(rng), 5);
    const RunChunk restored = random_chunk(rng, now.extent, now.order, 5);
    std::vector<Difference> differences;
    append_differences(now, restored, differences);
    const auto careful = careful_restore_pastes(now, differences, {0, 0, 0});
    // Another player builds with a material that the chunk did not have.
    DenseChunk since = DenseChunk::of(now);
    EditDescriptor built = random_edit_near(rng, {0, 0, 0}, now.extent);
    if (!std::holds_alternative<Paste>(built.shape)) built.material = 77;
    oracle_apply(since, {0, 0, 0}, {&built, 1});
    DenseChunk expected = since;
    const DenseChunk was = DenseChunk::of(now);
    const DenseChunk ought = DenseChunk::of(restored);
    for (int z = 0; z < 16; ++z) {
      for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
          if (since.at(x, y, z) == was.at(x, y, z)) expected.set(x, y, z, ought.at(x, y, z));
        }
      }
    }
    oracle_apply(since, {0, 0, 0}, careful);
    CAPTURE(Catch::rngSeed(), round, built);
    REQUIRE(since == expected);
  }
}

TEST_CASE("differences that are too large for one clipboard are pasted in parts", "[rollback]") {
  SplitMix64 rng(6);
  // The voxels are noise of many materials, more than a clipboard may hold.
  const RunChunk now =
      random_chunk(rng, Extent::cube(64), AxisOrder::zxy, 40'000, ChunkShape::noise);
  const RunChunk restored = random_chunk(rng, now.extent, now.order, 40'000, ChunkShape::noise);
  std::vector<Difference> differences;
  append_differences(now, restored, differences);
  const VoxelPos origin = {-64, 128, 64};
  const auto pastes = restore_pastes(now, differences, origin);
  CHECK(pastes.size() > 4);
  for (const EditDescriptor& paste : pastes) {
    REQUIRE(validate(paste).has_value());
    REQUIRE(touched_chunks(paste, 64) == std::vector<ChunkCoord>{chunk_of(origin, 64)});
  }
  REQUIRE(pasted(now, origin, pastes) == DenseChunk::of(restored));
}

}  // namespace runstone::test
