// Borders that whole meshes make and whole meshes beside them use: through the pool, and as the planner keeps
// them.
#include <catch2/catch.hpp>
#include <memory>
#include <thread>
#include <utility>

#include "client/replica/layer_diff.hpp"
#include "client/schedule/mesh_pool.hpp"
#include "tests/support/mesh_scene.hpp"
#include "tests/unit/schedule/planner_bench.hpp"

using namespace runstone;
using test::PlannerBench;

namespace {

constexpr auto kRight = static_cast<std::size_t>(Direction::pos_x);
constexpr auto kLeft = static_cast<std::size_t>(Direction::neg_x);
constexpr auto kBack = static_cast<std::size_t>(Direction::pos_z);

std::unique_ptr<MeshPool> pool_of(VisibilityTable visibility, unsigned workers = 0) {
  return std::make_unique<MeshPool>(std::move(visibility), workers, [] { return std::int64_t{0}; }, nullptr);
}

MeshResult result_in(MeshPool& pool, MeshJob job) {
  REQUIRE(pool.push(std::move(job)));
  for (;;) {
    auto results = pool.take_results();
    if (!results.empty()) return std::move(results.front());
    std::this_thread::yield();
  }
}

ShownPtr shown(RunChunk chunk) { return std::make_shared<RunChunk>(std::move(chunk)); }

/// Two chunks that are not of one material, with a stone each where they touch, in a view of five; the meshes
/// come from a pool.
struct TwoStones : PlannerBench {
  TwoStones() {
    static_cast<void>(world.commit({9, 1, ++edits}, {SetVoxel{{15, 5, 5}}, {}, test::kStone}));
    static_cast<void>(world.commit({9, 1, ++edits}, {SetVoxel{{16, 5, 5}}, {}, test::kStone}));
    load_all();
    mesh();
  }
  void mesh() {
    while (auto job = planner.next()) {
      MeshResult result = result_in(*pool, *job);
      CHECK(planner.finish(result.key, result.number, result.mesh, result.borders));
      quads[job->key.at] = result.mesh->quad_count();
      made[job->key.at] = std::move(*job);
    }
  }
  /// Has the middle meshed as a whole once more: one of its neighbours goes and comes.
  void come_and_go() {
    replica.receive(ChunkUnavailable{{{0, {0, 0, 1}}}, UnavailableReason::damaged});
    tell();
    replica.receive(world.snapshot({0, 0, 1}), {});
    tell();
  }
  const MeshJob& middle() { return made[{0, 0, 0}]; }

  std::unique_ptr<MeshPool> pool = pool_of(test::mesh_visibility());
  std::map<ChunkCoord, std::size_t> quads;
};

}  // namespace

TEST_CASE("a mesh is the same with the borders that the meshes beside it made", "[schedule]") {
  const auto pool = pool_of(test::mesh_visibility(), GENERATE(0U, 1U));
  SplitMix64 rng(51);
  for (int round = 0; round < 200; ++round) {
    const test::MeshScene scene = test::random_scene(rng, 16);
    MeshJob job;
    job.chunk = shown(scene.chunk);
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      if (!scene.neighbours[d]) continue;
      MeshJob beside;
      beside.chunk = job.neighbours[d] = shown(*scene.neighbours[d]);
      job.borders[d] = result_in(*pool, std::move(beside)).borders;
      CHECK((job.borders[d] == nullptr) == scene.neighbours[d]->is_uniform());
    }
    const ChunkMesh plain = test::mesh_of(scene);
    const MeshPtr mesh = result_in(*pool, job).mesh;
    CAPTURE(round);
    REQUIRE(mesh->opaque.quads == plain.opaque.quads);
    REQUIRE(mesh->opaque.first == plain.opaque.first);
    REQUIRE(mesh->transparent.quads == plain.transparent.quads);
    REQUIRE(mesh->transparent.first == plain.transparent.first);
  }
}

TEST_CASE("a job's borders are used in place of the runs, and by whole meshes only", "[schedule]") {
  const auto pool = pool_of(test::mesh_visibility());
  const auto with = [](Material most, LocalPos at, Material there) {
    RunChunk chunk = uniform_chunk(Extent::cube(16), most);
    fill(chunk, index_of(at, chunk.extent, chunk.order), 1, there);
    return chunk;
  };
  MeshJob job;
  job.chunk = shown(with(kEmpty, {15, 5, 5}, test::kStone));
  job.neighbours[kRight] = shown(with(kEmpty, {8, 8, 8}, test::kStone));
  CHECK(result_in(*pool, job).mesh->quad_count() == 6);
  const auto wall = std::make_shared<ChunkBorders>();
  wall->read(with(test::kStone, {8, 8, 8}, kEmpty), test::mesh_visibility());
  job.borders[kRight] = wall;
  const MeshResult whole = result_in(*pool, job);
  CHECK(whole.mesh->quad_count() == 5);
  job.before = whole.mesh;
  job.changed.dirty = all_layers(job.chunk->extent);
  CHECK(result_in(*pool, job).borders == nullptr);
}

TEST_CASE_METHOD(TwoStones, "a mesh gets the borders of the chunks beside it that were meshed before",
                 "[schedule]") {
  CHECK(quads[{0, 0, 0}] == 5);
  CHECK(quads[{1, 0, 0}] == 5);
  // One of the two was the first; the other got its borders. Chunks of air have none.
  CHECK((middle().borders[kRight] == nullptr) != (made[{1, 0, 0}].borders[kLeft] == nullptr));
  CHECK(middle().borders[kBack] == nullptr);
  come_and_go();
  mesh();
  REQUIRE(middle().borders[kRight] != nullptr);
  CHECK(quads[{0, 0, 0}] == 5);
  const auto first = middle().borders[kRight];
  come_and_go();
  mesh();
  CHECK(middle().borders[kRight] == first);
}

TEST_CASE_METHOD(TwoStones, "borders are dropped with the voxels they are of", "[schedule]") {
  SECTION("not where only the chunk beside it changed") {
    commit({15, 6, 5}, test::kStone);
    mesh();
    REQUIRE(made[{1, 0, 0}].before != nullptr);
    come_and_go();
    mesh();
    CHECK(middle().borders[kRight] != nullptr);
  }
  SECTION("by an edit; a mesh of layers makes none, and gets none") {
    commit({16, 5, 5}, kEmpty);
    mesh();
    CHECK(middle().before != nullptr);
    CHECK(middle().borders[kRight] == nullptr);
    come_and_go();
    mesh();
    CHECK(middle().before == nullptr);
    CHECK(middle().borders[kRight] == nullptr);
    CHECK(quads[{0, 0, 0}] == 6);
  }
  SECTION("by an edit of which the planner was not told yet") {
    come_and_go();
    REQUIRE(
        replica.receive(world.commit({9, 1, ++edits}, {SetVoxel{{16, 5, 5}}, {}, kEmpty}), {}).has_value());
    mesh();
    CHECK(middle().before == nullptr);
    CHECK(middle().borders[kRight] == nullptr);
    CHECK(quads[{0, 0, 0}] == 6);
  }
  SECTION("those of a mesh that was under way when the edit came") {
    come_and_go();
    const auto job = planner.next();
    REQUIRE(job);
    REQUIRE(job->key.at == ChunkCoord{0, 0, 0});
    REQUIRE(job->before == nullptr);
    MeshResult result = result_in(*pool, *job);
    commit({15, 5, 5}, kEmpty);
    CHECK(planner.finish(result.key, result.number, result.mesh, result.borders));
    mesh();
    planner.set_eye({1, 0, 0});  // it comes before the middle
    replica.receive(ChunkUnavailable{{{0, {1, 0, 0}}}, UnavailableReason::damaged});
    tell();
    load({1, 0, 0});
    mesh();
    CHECK(made[{1, 0, 0}].before == nullptr);
    CHECK(made[{1, 0, 0}].borders[kLeft] == nullptr);
    CHECK(quads[{1, 0, 0}] == 6);
  }
}

TEST_CASE_METHOD(TwoStones, "kept borders are counted, and dropped when materials look different",
                 "[schedule]") {
  come_and_go();
  mesh();
  const auto borders = middle().borders[kRight];
  REQUIRE(borders != nullptr);
  CHECK(borders->byte_size() == 6 * 16 * sizeof(std::uint32_t));
  const std::size_t of_each =
      sizeof(ChunkMesh) + 5 * sizeof(Quad) + sizeof(ChunkBorders) + borders->byte_size();
  CHECK(planner.kept_bytes() == 2 * of_each);
  come_and_go();
  const auto out = planner.next();
  REQUIRE(out);
  MeshResult late = result_in(*pool, *out);

  planner.forget_meshes();
  CHECK(planner.kept_bytes() == 0);
  CHECK_FALSE(planner.finish(late.key, late.number, late.mesh, late.borders));
  CHECK(planner.kept_bytes() == 0);
  MaterialTable glass;
  REQUIRE(glass.add({"pane", {}, Visibility::transparent, {}}).has_value());
  pool = pool_of(VisibilityTable(glass));
  for (auto job = planner.next(); job; job = planner.next()) {
    for (const auto& kept : job->borders) CHECK(kept == nullptr);
    REQUIRE(planner.finish(job->key, job->number, result_in(*pool, *job).mesh));
  }
}
