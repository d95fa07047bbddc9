#include "client/far/far_planner.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <deque>
#include <map>
#include <set>

#include "client/far/far_cover.hpp"
#include "common/core/hash.hpp"
#include "common/core/tile_keys.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/unit/client/far/cover_model.hpp"
#include "tests/unit/client/far/some_tile.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

View wide_view(std::uint8_t levels) {
  View view;
  view.radius_h = 8;
  view.radius_v = 3;
  view.levels = levels;
  return view;
}

/// Tiles, their planner, and a screen that uploads finer levels first.
struct FarBench {
  explicit FarBench(std::uint8_t levels) { tiles.set_view(wide_view(levels), kTileEdge); }

  void pass() {
    planner.take(tiles.drain_changes());
    for (const ChunkKey& key : planner.take_removals()) {
      std::erase_if(uploads, [&key](const FarMeshJob& job) { return job.key == key; });
      cover.remove(key);
      present.erase(key);
    }
  }
  void hold(ChunkCoord at) {
    planner.set_chunk(at, true);
    cover.put({0, at}, true);
    present.insert({0, at});
  }
  void drop(ChunkCoord at) {
    planner.set_chunk(at, false);
    cover.remove({0, at});
    present.erase({0, at});
  }
  bool begin_job() {
    auto job = planner.next();
    if (job) jobs.push_back(*job);
    return job.has_value();
  }
  void end_job(std::size_t i) {
    const FarMeshJob job = jobs[i];
    jobs.erase(jobs.begin() + static_cast<std::ptrdiff_t>(i));
    if (!planner.finish(job.key, job.number)) return;
    std::erase_if(uploads, [&job](const FarMeshJob& other) { return other.key == job.key; });
    uploads.push_back(job);
    std::ranges::stable_sort(uploads, {}, [](const FarMeshJob& each) { return each.key.lod; });
  }
  bool upload() {
    if (uploads.empty()) return false;
    const FarMeshJob& job = uploads.front();
    cover.put(job.key, job.with_octants || is_empty(*job.tile));
    present.insert(job.key);
    drawn[job.key] = job.tile;
    uploads.erase(uploads.begin());
    return true;
  }
  void settle() {
    pass();
    while (begin_job() || !jobs.empty() || upload()) {
      if (!jobs.empty()) end_job(0);
    }
  }

  FarTiles tiles;
  FarPlanner planner{tiles};
  FarCover cover;
  std::deque<FarMeshJob> jobs;
  std::vector<FarMeshJob> uploads;
  std::set<ChunkKey> present;
  std::map<ChunkKey, TilePtr> drawn;
};

}  // namespace

TEST_CASE("a tile gets octants as soon as something below it is held", "[far]") {
  SplitMix64 rng{1};
  FarBench bench(2);
  const ChunkKey tile{1, {0, 0, 0}};
  REQUIRE(bench.tiles.receive(tile, Chunk{some_tile(rng), {}, {}}));
  bench.pass();
  auto job = bench.planner.next();
  REQUIRE(job);
  CHECK_FALSE(job->with_octants);
  REQUIRE(bench.planner.finish(tile, job->number));
  CHECK_FALSE(bench.planner.next());
  bench.planner.set_chunk({1, 1, 0}, true);
  job = bench.planner.next();
  REQUIRE(job);
  CHECK(job->with_octants);
  CHECK(bench.planner.dirty_count() == 0);
}

TEST_CASE("finer levels come first, and in a level the nearest tile", "[far]") {
  SplitMix64 rng{2};
  FarBench bench(3);
  bench.planner.set_eye({3, 0, 0});
  for (const ChunkKey& key :
       {ChunkKey{3, {-1, 0, 0}}, ChunkKey{2, {4, 0, 0}}, ChunkKey{2, {-2, 0, 0}}})
    REQUIRE(bench.tiles.receive(key, Chunk{some_tile(rng), {}, {}}));
  bench.pass();
  CHECK(bench.planner.next()->key == ChunkKey{2, {-2, 0, 0}});
  CHECK(bench.planner.next()->key == ChunkKey{2, {4, 0, 0}});
  bench.planner.finish({2, {-2, 0, 0}}, 1);
  CHECK(bench.planner.next()->key == ChunkKey{3, {-1, 0, 0}});
}

TEST_CASE("coarse ground that arrives late does not hide finer ground for a moment", "[far]") {
  SplitMix64 rng{3};
  FarBench bench(4);
  const ChunkKey top{4, {0, 0, 0}};
  bench.hold({5, 3, 9});
  REQUIRE(bench.tiles.receive(top, Chunk{some_tile(rng), {}, {}}));
  bench.pass();
  CHECK(bench.planner.stand_in_count() == 3);
  while (bench.begin_job() || !bench.jobs.empty() || bench.upload()) {
    if (!bench.jobs.empty()) bench.end_job(bench.jobs.size() - 1);
    CHECK(bench.cover.shows({0, {5, 3, 9}}));
  }
  CHECK_FALSE(bench.cover.parts(top).is_whole);
  CHECK(bench.drawn.size() == 4);
}

TEST_CASE("a tile that arrives replaces its stand-in and those made from it", "[far]") {
  SplitMix64 rng{4};
  FarBench bench(3);
  const ChunkKey top{3, {0, 0, 0}};
  const ChunkKey middle = tile_child(top, 0), low = tile_child(middle, 0);
  bench.hold({0, 0, 0});
  REQUIRE(bench.tiles.receive(top, Chunk{some_tile(rng), {}, {}}));
  bench.settle();
  CHECK(bench.planner.stand_in_count() == 2);
  CHECK(bench.planner.bytes() > 0);
  const RunChunk arrived = some_tile(rng);
  REQUIRE(bench.tiles.receive(middle, Chunk{arrived, {}, {}}));
  bench.settle();
  CHECK(bench.planner.stand_in_count() == 1);
  CHECK(*bench.drawn.at(middle) == arrived);
  for (std::uint8_t x = 0; x < kTileEdge; ++x) {
    CHECK(material_at(*bench.drawn.at(low), {x, 3, 4}) ==
          material_at(arrived, {static_cast<std::uint8_t>(x / 2), 1, 2}));
  }
  bench.drop({0, 0, 0});
  bench.settle();
  CHECK(bench.planner.stand_in_count() == 0);
  CHECK(bench.planner.bytes() == 0);
  CHECK(bench.present == std::set<ChunkKey>{top, middle});
}

TEST_CASE("other materials mesh every tile again", "[far]") {
  SplitMix64 rng{5};
  FarBench bench(2);
  REQUIRE(bench.tiles.receive({1, {0, 0, 0}}, Chunk{some_tile(rng), {}, {}}));
  REQUIRE(bench.tiles.receive({2, {0, 0, 0}}, Chunk{some_tile(rng), {}, {}}));
  bench.pass();
  const auto open = bench.planner.next();
  REQUIRE(open);
  bench.planner.set_visibility(mesh_visibility());
  CHECK(bench.planner.dirty_count() == 2);
  CHECK_FALSE(bench.planner.finish(open->key, open->number));
  bench.settle();
  CHECK(bench.present.size() == 2);
}

TEST_CASE("tiles are meshed with a veil, whatever the server did", "[far]") {
  const Extent extent = Extent::cube(kTileEdge);
  const RunChunk stone = uniform_chunk(extent, kStone, AxisOrder::xyz);
  RunChunk with_dirt = stone;
  fill(with_dirt, index_of({5, 5, 5}, extent, AxisOrder::xyz), 1, kDirt);
  fill(with_dirt, 0, 1, kDirt);
  RunChunk veiled = stone;
  fill(veiled, 0, 1, kDirt);

  FarBench bench(2);
  bench.planner.set_visibility(mesh_visibility());
  const ChunkKey veiled_here{1, {0, 0, 0}}, veiled_there{1, {1, 0, 0}};
  REQUIRE(bench.tiles.receive(veiled_here, Chunk{with_dirt, {}, {}}));
  REQUIRE(bench.tiles.receive(veiled_there, Chunk{veiled, {}, {}}));
  bench.settle();
  CHECK(*bench.drawn.at(veiled_here) == veiled);
  CHECK(*bench.tiles.find(veiled_here) == with_dirt);  // for claims and the cache
  CHECK(bench.drawn.at(veiled_there) == bench.tiles.find(veiled_there));
  CHECK(bench.planner.bytes() == sizeof(RunChunk) + veiled.runs.byte_size());

  // The same after other materials, and without the tiles nothing is left.
  bench.planner.set_visibility(mesh_visibility());
  bench.settle();
  CHECK(*bench.drawn.at(veiled_here) == veiled);
  CHECK(bench.planner.bytes() == sizeof(RunChunk) + veiled.runs.byte_size());
  bench.tiles.clear();
  bench.settle();
  CHECK(bench.planner.bytes() == 0);
}

TEST_CASE("known ground is drawn exactly once while tiles and chunks come, go and are meshed late",
          "[far][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  CAPTURE(Catch::rngSeed());
  FarBench bench(3);
  const ChunkKey top{3, {0, 0, 0}};
  CoverModel model{top};
  std::set<ChunkCoord> known, chunks;
  for (int step = 0; step < 4'000; ++step) {
    CAPTURE(step);
    const auto within = [&] { return static_cast<std::int32_t>(rng.below(8)); };
    const ChunkCoord cell{within(), within(), within()};
    const auto kind = rng.below(12);
    if (kind < 3) {
      bench.hold(cell);
      chunks.insert(cell);
    } else if (kind < 5) {
      bench.drop(cell);
      bench.pass();
      chunks.erase(cell);
      known.clear();
    } else if (kind < 7) {
      const ChunkKey key = tile_of(cell, static_cast<std::uint8_t>(1 + rng.below(3)));
      if (rng.below(5) == 0) {
        bench.tiles.receive_uniform(key, rng.below(4) == 0 ? kEmpty : Material{1});
        known.clear();
      } else {
        bench.tiles.receive(key, Chunk{some_tile(rng), {}, {}});
      }
      bench.pass();
    } else if (kind == 7 && rng.below(20) == 0) {
      bench.tiles.set_view(wide_view(static_cast<std::uint8_t>(rng.below(4))), kTileEdge);
      bench.pass();
      known.clear();
    } else if (kind < 10) {
      bench.begin_job();
      if (!bench.jobs.empty())
        bench.end_job(rng.below(static_cast<std::uint32_t>(bench.jobs.size())));
    } else {
      bench.upload();
    }
    if (step % 5 == 0) {
      model.present = bench.present;
      REQUIRE(model.faults(bench.cover).empty());
      // Ground that is drawn stays drawn until a chunk or a tile leaves.
      for (const ChunkCoord at : known) REQUIRE(model.is_known(at));
      for (const auto& [at, count] : model.drawn(bench.cover)) {
        if (count == 1) known.insert(at);
      }
    }
    if (step % 400 != 399) continue;
    bench.settle();
    CHECK(bench.planner.dirty_count() == 0);
    CHECK(bench.planner.ready_count() == 0);
    // No gap is left that would hide a chunk.
    for (const ChunkCoord at : chunks) REQUIRE(bench.cover.shows({0, at}));
  }
}
