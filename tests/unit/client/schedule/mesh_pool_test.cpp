#include "client/schedule/mesh_pool.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <map>
#include <thread>
#include <vector>

#include "common/runs/layer_diff.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

using namespace runstone;

namespace {

constexpr std::int32_t kEdge = 16;

ShownPtr chunk_with(const std::vector<LocalPos>& stones) {
  auto chunk = std::make_shared<RunChunk>(uniform_chunk(Extent::cube(kEdge), kEmpty));
  for (const LocalPos at : stones)
    fill(*chunk, index_of(at, chunk->extent, chunk->order), 1, test::kStone);
  return chunk;
}

constexpr std::size_t kScattered = 63;

/// Returns these voxels and kScattered others in a corner, no two of which share a face. In such a
/// chunk, meshing a few layers costs less than meshing the whole chunk.
std::vector<LocalPos> among_others(std::vector<LocalPos> voxels) {
  constexpr std::uint8_t kFirst = 11, kEnd = 16;
  for (std::uint8_t x = kFirst; x < kEnd; ++x)
    for (std::uint8_t y = kFirst; y < kEnd; ++y)
      for (std::uint8_t z = kFirst; z < kEnd; ++z)
        if ((x + y + z) % 2 != 0) voxels.push_back({x, y, z});
  return voxels;
}

MeshJob job_of(std::uint64_t number, ShownPtr chunk) {
  MeshJob job;
  job.key = {0, {static_cast<std::int32_t>(number), 0, 0}};
  job.number = number;
  job.serial = 100 + number;
  job.chunk = std::move(chunk);
  return job;
}

/// A pool and its results.
struct Bench {
  explicit Bench(unsigned workers)
      : pool(std::make_unique<MeshPool>(
            test::mesh_visibility(), workers, [this] { return now += 1000; },
            [this] { ++woken; })) {}
  MeshResult result_of(std::uint64_t number) {
    while (!results.contains(number)) {
      for (MeshResult& result : pool->take_results()) results[result.number] = std::move(result);
      std::this_thread::yield();
    }
    return results[number];
  }
  std::atomic<std::int64_t> now{0};
  std::atomic<int> woken{0};
  std::map<std::uint64_t, MeshResult> results;
  std::unique_ptr<MeshPool> pool;
};

}  // namespace

TEST_CASE("workers mesh every job and report the time", "[schedule]") {
  const unsigned workers = GENERATE(0U, 2U);
  CAPTURE(workers);
  Bench bench(workers);
  for (std::uint64_t i = 1; i <= 5; ++i) {
    REQUIRE(bench.pool->push(job_of(i, i == 3 ? chunk_with({{5, 5, 5}}) : chunk_with({}))));
  }
  for (std::uint64_t i = 1; i <= 5; ++i) {
    const MeshResult result = bench.result_of(i);
    CHECK(result.key.at.x == static_cast<std::int32_t>(i));
    CHECK(result.serial == 100 + i);
    CHECK(result.edge == kEdge);
    CHECK(result.mesh_ns >= 1000);
    CHECK(result.meshed_us > 0);
    CHECK_FALSE(result.layers_only);
    CHECK(result.mesh->quad_count() == (i == 3 ? 6 : 0));
  }
  CHECK(bench.results[1].mesh == bench.results[2].mesh);  // chunks without quads share one mesh
  CHECK(bench.pool->in_flight() == 0);
  bench.pool.reset();  // the last worker may not have called wake yet
  CHECK(bench.woken == (workers == 0 ? 0 : 5));
}

TEST_CASE("a job with a previous mesh meshes the changed layers and leaves that mesh unchanged",
          "[schedule]") {
  Bench bench(GENERATE(0U, 1U));
  constexpr std::size_t kOthers = 6 * kScattered;  // quads
  const ShownPtr old_chunk = chunk_with(among_others({{5, 5, 5}, {0, 9, 9}}));
  const ShownPtr old_side = chunk_with({});
  MeshJob first = job_of(1, old_chunk);
  first.neighbours[0] = old_side;
  REQUIRE(bench.pool->push(first));
  const MeshPtr before = bench.result_of(1).mesh;
  REQUIRE(before->quad_count() == 12 + kOthers);

  MeshJob second = job_of(2, chunk_with(among_others({{5, 5, 5}, {6, 5, 5}, {0, 9, 9}})));
  second.neighbours[0] = chunk_with({{15, 9, 9}});  // hides a face of the voxel beside it
  second.before = before;
  second.changed.here = changed_layers(*old_chunk, *second.chunk);
  second.changed.beyond[0] = changed_layers(*old_side, *second.neighbours[0]);
  MeshJob whole = second;
  whole.number = 3;
  whole.before = nullptr;
  REQUIRE(bench.pool->push(second));
  REQUIRE(bench.pool->push(whole));
  const MeshResult layers = bench.result_of(2);
  CHECK(layers.layers_only);
  CHECK(layers.mesh->quad_count() == 11 + kOthers);
  CHECK(layers.mesh->opaque.quads == bench.result_of(3).mesh->opaque.quads);
  CHECK(layers.mesh->opaque.first == bench.result_of(3).mesh->opaque.first);
  CHECK(before->quad_count() == 12 + kOthers);

  // Only the layers named in the job are meshed.
  second.number = 4;
  second.changed.beyond = {};
  REQUIRE(bench.pool->push(second));
  CHECK(bench.result_of(4).mesh->quad_count() == 12 + kOthers);
}

TEST_CASE("the pushing thread can mesh a job itself while the workers are busy", "[schedule]") {
  Bench bench(1);
  const MeshResult result = bench.pool->mesh_here(job_of(1, chunk_with({{5, 5, 5}})));
  CHECK(result.number == 1);
  CHECK(result.mesh->quad_count() == 6);
  CHECK(bench.pool->in_flight() == 0);
  CHECK(bench.pool->take_results().empty());
}

TEST_CASE("a result has no spare capacity from larger meshes before it", "[schedule]") {
  Bench bench(0);
  std::initializer_list<LocalPos> many = {{1, 1, 1}, {3, 1, 1}, {5, 1, 1},
                                          {7, 1, 1}, {9, 1, 1}, {11, 1, 1}};
  REQUIRE(bench.pool->push(job_of(1, chunk_with(many))));
  REQUIRE(bench.pool->push(job_of(2, chunk_with({{1, 1, 1}}))));
  CHECK(bench.result_of(1).mesh->opaque.quads.capacity() == 36);
  CHECK(bench.result_of(2).mesh->opaque.quads.capacity() == 6);
}

TEST_CASE("a mesh of layers has little spare capacity, however many quads come and go",
          "[schedule]") {
  Bench bench(0);
  std::vector<LocalPos> voxels = among_others({});
  ShownPtr chunk = chunk_with(voxels);
  REQUIRE(bench.pool->push(job_of(1, chunk)));
  MeshPtr mesh = bench.result_of(1).mesh;
  std::uint64_t number = 1;
  const auto change_to = [&](const std::vector<LocalPos>& stones) {
    MeshJob job = job_of(++number, chunk_with(stones));
    job.before = mesh;
    job.changed.here = changed_layers(*chunk, *job.chunk);
    chunk = job.chunk;
    REQUIRE(bench.pool->push(std::move(job)));
    MeshResult result = bench.result_of(number);
    mesh = result.mesh;
    const auto& quads = mesh->opaque.quads;
    CHECK(quads.capacity() <= quads.size() + 128);
    CHECK(mesh->transparent.quads.capacity() == 0);
    return result.layers_only;
  };
  unsigned by_layers = 0;
  for (std::uint8_t x = 0; x < 10; x = static_cast<std::uint8_t>(x + 2)) {
    voxels.push_back({x, 1, 1});
    by_layers += change_to(voxels) ? 1 : 0;
  }
  CHECK(by_layers == 5);
  CHECK(mesh->quad_count() == 6 * (kScattered + 5));
  // Many quads appear, and many disappear.
  const std::vector<LocalPos> few = voxels;
  for (std::uint8_t y = 0; y < 10; ++y)
    for (std::uint8_t x = y % 2; x < 10; x = static_cast<std::uint8_t>(x + 2))
      voxels.push_back({x, y, 4});
  change_to(voxels);
  CHECK(mesh->quad_count() == 6 * (kScattered + 55));
  change_to(few);
  CHECK(mesh->quad_count() == 6 * (kScattered + 5));
}

TEST_CASE("a job of layers does not read the runs of a neighbour whose borders are kept",
          "[schedule]") {
  Bench bench(0);
  const ShownPtr old_chunk = chunk_with(among_others({{0, 9, 9}}));
  MeshJob job = job_of(1, old_chunk);
  job.neighbours[0] = chunk_with({{15, 9, 9}, {15, 3, 3}});
  REQUIRE(bench.pool->push(job));
  job.before = bench.result_of(1).mesh;
  job.number = 2;
  job.chunk = chunk_with(among_others({{0, 9, 9}, {0, 3, 3}}));
  job.changed.here = changed_layers(*old_chunk, *job.chunk);
  // These borders are of other runs, so that the test sees which of both was read.
  auto borders = std::make_shared<ChunkBorders>();
  borders->read(*chunk_with({{15, 9, 9}, {15, 12, 12}}), test::mesh_visibility());
  job.borders[0] = std::move(borders);
  REQUIRE(bench.pool->push(job));
  CHECK(bench.result_of(2).layers_only);
  CHECK(bench.result_of(2).mesh->quad_count() == 6 * kScattered + 5 + 6);
}

TEST_CASE("a pool that is full takes no more jobs until results are taken", "[schedule]") {
  Bench bench(1);
  std::uint64_t pushed = 0;
  while (bench.pool->push(job_of(pushed + 1, chunk_with({})))) ++pushed;
  CHECK(pushed == bench.pool->capacity());
  static_cast<void>(bench.result_of(pushed));
  CHECK(bench.pool->push(job_of(pushed + 1, chunk_with({}))));
}

TEST_CASE("a worker meshes a tile while chunks wait, and takes a bounded number of tiles",
          "[schedule]") {
  const unsigned workers = GENERATE(0U, 1U);
  CAPTURE(workers);
  Bench bench(workers);
  std::size_t pushed = 0;
  while (bench.pool->has_room_for_tiles()) {
    FarMeshJob job{{1, {0, 0, 0}}, ++pushed, chunk_with({{5, 5, 5}}), true};
    REQUIRE(bench.pool->push(std::move(job)));
  }
  CHECK(pushed <= MeshPool::kTilesPerWorker);
  for (std::uint64_t i = 1; workers == 1 && i <= 8; ++i)
    REQUIRE(bench.pool->push(job_of(i, chunk_with({}))));
  std::vector<FarMeshResult> tiles;
  while (tiles.size() < pushed) {
    for (FarMeshResult& tile : bench.pool->take_tiles()) tiles.push_back(std::move(tile));
    std::this_thread::yield();
  }
  CHECK(bench.pool->tiles_in_flight() == 0);
  for (const FarMeshResult& tile : tiles) {
    CHECK(tile.edge == kEdge);
    CHECK(tile.mesh->whole.quad_count() == 6);
    CHECK(tile.mesh->octants.size() == 8);
  }
}

TEST_CASE("a result names the sides without a neighbour", "[schedule]") {
  Bench bench(0);
  MeshJob job = job_of(1, chunk_with({{5, 5, 5}}));
  job.neighbours[2] = chunk_with({});
  REQUIRE(bench.pool->push(std::move(job)));
  CHECK(bench.result_of(1).open_sides == 0b111011);
}
