#include "server/rollback/preview_edits.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/runs/random_chunk.hpp"
#include "tests/unit/server/rollback/rollback_bench.hpp"

namespace runstone::test {
namespace {

constexpr View kView{1, {0, 0, 0}, 2, 1};

/// A plan that changes every voxel of a chunk from stone to noise.
RestorePlan noisy_plan(SplitMix64& rng, ChunkCoord at, unsigned edge = kEdge) {
  RestorePlan plan;
  plan.key = {0, at};
  plan.now = uniform_chunk(Extent::cube(edge), 4);
  plan.restored = random_chunk(rng, Extent::cube(edge), AxisOrder::xyz, 4, ChunkShape::noise);
  append_differences(plan.now, plan.restored, plan.differences);
  return plan;
}

RestorePlan small_plan(ChunkCoord at, Material now, Material restored) {
  RestorePlan plan;
  plan.key = {0, at};
  plan.now = plan.restored = uniform_chunk(Extent::cube(kEdge), kEmpty);
  if (now != kEmpty) fill(plan.now, 5, 3, now);
  if (restored != kEmpty) fill(plan.restored, 5, 3, restored);
  append_differences(plan.now, plan.restored, plan.differences);
  return plan;
}

RestorePreview taken(PreviewEdits& edits) {
  RestorePreview out;
  edits.take(out);
  return out;
}

}  // namespace

TEST_CASE("a preview has the edits of the chunks in view, near ones first", "[rollback]") {
  PreviewEdits edits(kView);
  edits.add(small_plan({2, 0, 0}, 1, kEmpty));
  edits.add(small_plan({0, 1, 0}, kEmpty, 2));
  edits.add(small_plan({3, 0, 0}, 1, kEmpty));  // outside
  edits.add(small_plan({0, 2, 0}, 1, kEmpty));  // above
  edits.add(small_plan({1, 0, 1}, 1, 1));       // nothing changes
  const RestorePreview shown = taken(edits);
  REQUIRE(shown.edits.size() == 2);
  CHECK_FALSE(shown.is_cut);
  CHECK(std::get<FillBox>(shown.edits[0].shape).box.min.y / kEdge == 1);
  CHECK(std::get<FillBox>(shown.edits[1].shape).box.min.x / kEdge == 2);
}

TEST_CASE("a preview without room keeps the nearest changes and says so", "[rollback]") {
  SplitMix64 rng(7);
  PreviewEdits edits({1, {0, 0, 0}, 64, 64});
  for (std::int32_t x = 0; x < 40; ++x) edits.add(noisy_plan(rng, {(x * 7) % 40, 0, 0}, 32));
  const RestorePreview shown = taken(edits);
  CHECK(shown.is_cut);
  REQUIRE_FALSE(shown.edits.empty());
  CHECK(shown.edits.size() <= kRestorePreviewEditsMax);
  std::size_t bytes = 0;
  std::int32_t before = 0;
  for (const EditDescriptor& edit : shown.edits) {
    bytes += encode(edit).size();
    const std::int32_t chunk = std::get<Paste>(edit.shape).at.x / 32;
    CHECK(chunk >= before);
    before = chunk;
  }
  CHECK(bytes <= kRestorePreviewBytesMax);
  CHECK(bytes > kRestorePreviewBytesMax / 2);
  CHECK(before < 39);
}

TEST_CASE("a preview needs the plans of the chunks in view, and of many the nearest",
          "[rollback]") {
  PreviewEdits few(kView);
  const std::vector<ChunkKey> changing = {
      {0, {-2, 0, 0}}, {0, {0, 0, 0}}, {0, {0, 0, 9}}, {0, {2, 1, 0}}, {1, {0, 0, 0}}};
  CHECK(few.choose(changing) ==
        std::vector<ChunkKey>{{0, {-2, 0, 0}}, {0, {0, 0, 0}}, {0, {2, 1, 0}}});
  CHECK_FALSE(taken(few).is_cut);

  PreviewEdits many({1, {3, 0, 0}, 64, 64});
  std::vector<ChunkKey> all;
  for (std::int32_t x = 0; x < 40; ++x) {
    for (std::int32_t z = 0; z < 40; ++z) all.push_back({0, {x, 0, z}});
  }
  const std::vector<ChunkKey> chosen = many.choose(all);
  CHECK(chosen.size() == kRestorePreviewEditsMax);
  CHECK(std::is_sorted(chosen.begin(), chosen.end()));
  const auto distance = [](const ChunkKey& key) {
    return (key.at.x - 3) * (key.at.x - 3) + key.at.z * key.at.z;
  };
  int farthest = 0;
  for (const ChunkKey& key : chosen) farthest = std::max(farthest, distance(key));
  for (const ChunkKey& key : all) {
    if (distance(key) >= farthest) continue;
    CHECK(std::binary_search(chosen.begin(), chosen.end(), key));
  }
  CHECK(taken(many).is_cut);
}

TEST_CASE("the edits of a preview restore the chunk", "[rollback]") {
  SplitMix64 rng(9);
  PreviewEdits edits(kView);
  const RestorePlan plan = noisy_plan(rng, {1, 0, 0});
  edits.add(plan);
  RunChunk chunk = plan.now;
  Digest digest = digest_of(chunk);
  ApplyScratch scratch;
  const RestorePreview shown = taken(edits);
  apply_stack(chunk, digest, origin_of(plan.key.at, kEdge), shown.edits, scratch);
  CHECK(DenseChunk::of(chunk) == DenseChunk::of(plan.restored));
}

TEST_CASE("a preview shows the plans that its viewer chooses", "[rollback]") {
  RollbackBench bench;
  const AuthorId griefer = bench.join(kGriefer);
  for (std::int32_t x = 0; x < 4; ++x) bench.set(kGriefer, {x * kEdge, 0, 0}, 2);
  bench.set(kGriefer, {3 * kEdge, 0, 0}, kEmpty);  // nothing of it is left there
  SelectionFilter filter;
  filter.authors = {griefer};
  std::vector<ChunkKey> offered, shown;
  RollbackPreview::PlanViewer viewer;
  viewer.choose = [&](const std::vector<ChunkKey>& changing) {
    offered = changing;
    return std::vector<ChunkKey>{changing.at(2), changing.at(0)};
  };
  viewer.add = [&](const RestorePlan& plan) {
    CHECK(plan.voxels == 1);
    shown.push_back(plan.key);
  };
  bench.service.preview(filter, bench.bench.now(), bench.reply(), viewer);
  bench.run_all();
  REQUIRE(bench.answer().restore != nullptr);
  CHECK(bench.answer().restore->voxels == 3);
  CHECK(bench.answer().restore->chunks == 3);
  CHECK(offered == std::vector<ChunkKey>{{0, {0, 0, 0}}, {0, {1, 0, 0}}, {0, {2, 0, 0}}});
  CHECK(shown == std::vector<ChunkKey>{{0, {2, 0, 0}}, {0, {0, 0, 0}}});
}

TEST_CASE("the answer to a preview has its id and counts for clients that show it", "[rollback]") {
  RollbackBench bench;
  const AuthorId griefer = bench.join(kGriefer);
  bench.fill(kGriefer, {{0, 0, 0}, {4, 4, 4}}, 2);
  SelectionFilter filter;
  filter.authors = {griefer};
  bench.service.preview(filter, bench.bench.now(), bench.reply());
  bench.run_all();
  REQUIRE(bench.answer().restore != nullptr);
  CHECK(bench.answer().restore->preview == "p1");
  CHECK(bench.answer().restore->voxels == 64);
  CHECK(bench.answer().restore->chunks == 1);
  filter.authors = {griefer + 100};
  bench.service.preview(filter, bench.bench.now(), bench.reply());
  bench.run_all();
  REQUIRE(bench.answer().restore != nullptr);
  CHECK(bench.answer().restore->preview.empty());
}

}  // namespace runstone::test
