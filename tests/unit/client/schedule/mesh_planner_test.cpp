#include "client/schedule/mesh_planner.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "common/mesh/shapes/shape_mesher.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/unit/client/schedule/planner_bench.hpp"

using namespace runstone;
using test::chunks_of;
using test::kBenchEdge;
using test::layers_of;
using test::PlannerBench;

TEST_CASE_METHOD(PlannerBench, "a chunk waits for its neighbours in view and not for those beyond",
                 "[schedule]") {
  load({0, 0, 0});
  CHECK(drain().empty());
  load({1, 0, 0});
  // Its one neighbour in view has arrived. The five beyond the view do not count.
  CHECK(drain() == std::vector<ChunkCoord>{{1, 0, 0}});
  CHECK(last.neighbours[static_cast<std::size_t>(Direction::neg_x)] != nullptr);
  CHECK(last.neighbours[static_cast<std::size_t>(Direction::pos_x)] == nullptr);
  load({-1, 0, 0});
  load({0, 0, 1});
  CHECK(drain() == std::vector<ChunkCoord>{{-1, 0, 0}, {0, 0, 1}});
  load({0, 0, -1});
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}, {0, 0, -1}});
  CHECK(planner.dirty_count() == 0);
}

TEST_CASE_METHOD(PlannerBench,
                 "an edited chunk does not wait for terrain, and is meshed again when it arrives",
                 "[schedule]") {
  load({0, 0, 0});
  CHECK(drain().empty());
  commit({5, 5, 5}, 2);
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}});
  CHECK(last.neighbours[static_cast<std::size_t>(Direction::pos_x)] == nullptr);
  load({1, 0, 0});
  CHECK(drain() ==
        std::vector<ChunkCoord>{{1, 0, 0}});  // no change: it waits for the other neighbours
  commit({6, 5, 5}, 2);
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}});
  CHECK(last.neighbours[static_cast<std::size_t>(Direction::pos_x)] != nullptr);
  load({-1, 0, 0});
  load({0, 0, 1});
  load({0, 0, -1});
  CHECK(drain().size() == 4);
  CHECK(made.at({0, 0, 0}).before == nullptr);
  CHECK(made.at({0, 0, 0}).neighbours[static_cast<std::size_t>(Direction::neg_z)] != nullptr);
  CHECK(planner.dirty_count() == 0);
}

TEST_CASE_METHOD(PlannerBench,
                 "a kept mesh with other neighbours makes the chunk be meshed as a whole",
                 "[schedule]") {
  load_all();
  drain();
  replica.set_view({1, {1, 0, 0}, 1, 0});  // three neighbours of the middle leave
  pass_changes();
  planner.view_changed();
  commit({5, 5, 5}, 2);
  CHECK_FALSE(planner.next(JobSize::layers));
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}});
  CHECK(last.before == nullptr);
}

TEST_CASE_METHOD(PlannerBench, "an edit whose job was made void by terrain does not wait either",
                 "[schedule]") {
  load({0, 0, 0});
  commit({5, 5, 5}, 2);
  const auto job = planner.next();
  REQUIRE(job);
  load({1, 0, 0});  // a side without a neighbour has one now
  CHECK_FALSE(finish(*job));
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}, {1, 0, 0}});
}

TEST_CASE_METHOD(PlannerBench,
                 "jobs of changed layers can be taken alone, and come before whole chunks",
                 "[schedule]") {
  planner.set_eye({1, 0, 0});
  load({0, 0, 0});
  load({1, 0, 0});
  load({-1, 0, 0});
  load({0, 0, 1});
  CHECK_FALSE(planner.next(JobSize::layers));
  CHECK(drain().size() == 3);
  load({0, 0, -1});       // two whole chunks: it, and the middle
  commit({5, 5, -5}, 2);  // edited, but without a kept mesh
  CHECK_FALSE(planner.next(JobSize::layers));
  planner.set_eye({0, 0, -1});
  commit({20, 5, 5}, 2);
  const auto layers = planner.next(JobSize::layers);
  REQUIRE(layers);
  CHECK(layers->key.at == ChunkCoord{1, 0, 0});
  CHECK(layers->before != nullptr);
  CHECK_FALSE(planner.next(JobSize::layers));
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, -1}, {0, 0, 0}});
}

TEST_CASE_METHOD(PlannerBench, "a chunk does not wait for a neighbour that the server cannot send",
                 "[schedule]") {
  load({0, 0, 0});
  load({-1, 0, 0});
  load({0, 0, 1});
  load({0, 0, -1});
  CHECK(drain().size() == 3);
  replica.receive(ChunkUnavailable{1, {{0, {1, 0, 0}}}, UnavailableReason::damaged});
  pass_changes();
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}});
  CHECK(last.neighbours[static_cast<std::size_t>(Direction::pos_x)] == nullptr);
  CHECK(planner.dirty_count() == 0);
  load({1, 0, 0});  // it arrives later: the neighbour is meshed again
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}, {1, 0, 0}});
}

TEST_CASE_METHOD(PlannerBench, "a chunk at the border of the world waits for nothing beyond it",
                 "[schedule]") {
  const ChunkCoord top{0, kWorldLimit / kBenchEdge - 1, 0};
  replica.set_view({2, top, 0, 1});  // the topmost chunk and the one below; nothing is above
  replica.receive(chunks_of(world.snapshot(top), 2), {});
  pass_changes();
  CHECK(drain().empty());
  replica.receive(chunks_of(world.snapshot({0, top.y - 1, 0}), 2), {});
  pass_changes();
  CHECK(drain().size() == 2);
}

TEST_CASE_METHOD(PlannerBench, "loading a view meshes every chunk once", "[schedule]") {
  load_all();
  CHECK(drain().size() == 5);
  CHECK(planner.jobs() == 5);
  CHECK(planner.chunks_meshed() == 5);
}

TEST_CASE_METHOD(PlannerBench,
                 "an edit meshes its chunk again, and the neighbour only at the border",
                 "[schedule]") {
  load_all();
  drain();
  commit({5, 5, 5}, 2);
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}});
  commit({15, 5, 5}, 2);
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}, {1, 0, 0}});
}

TEST_CASE_METHOD(PlannerBench, "changes are merged and the job has the newest runs", "[schedule]") {
  load_all();
  drain();
  commit({5, 5, 5}, 2);
  commit({6, 5, 5}, 3);
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}});
  CHECK(material_at(*last.chunk, {6, 5, 5}) == Material{3});
  CHECK(last.serial == replica.shown_serial({0, {0, 0, 0}}));
}

TEST_CASE_METHOD(PlannerBench, "edited chunks come first, then the nearest", "[schedule]") {
  planner.set_eye({1, 0, 0});
  load_all();
  auto order = drain();
  REQUIRE(order.size() == 5);
  CHECK(order[0] == ChunkCoord{1, 0, 0});
  CHECK(order[1] == ChunkCoord{0, 0, 0});
  CHECK(order[4] == ChunkCoord{-1, 0, 0});

  replica.receive(test::chunks_of(world.snapshot({0, 0, 0})), {});
  commit({5, 5, 5}, 2);    // at the eye
  commit({-10, 5, 5}, 2);  // far from the eye
  planner.set_eye({-1, 0, 0});
  order = drain();
  CHECK(order == std::vector<ChunkCoord>{{-1, 0, 0}, {0, 0, 0}});
}

TEST_CASE_METHOD(PlannerBench, "a chunk with an edit of this client comes before nearer ones",
                 "[schedule]") {
  load_all();
  drain();
  commit({5, 5, 5}, 2);  // at the eye
  REQUIRE(replica.predict({SetVoxel{{-10, 5, 5}}, {}, 2}, 0, 0).has_value());
  pass_changes();
  auto first = planner.next();
  auto second = planner.next();
  REQUIRE(first);
  REQUIRE(second);
  CHECK(first->key.at == ChunkCoord{-1, 0, 0});
  CHECK(first->urgency == Urgency::local_edit);
  CHECK(second->key.at == ChunkCoord{0, 0, 0});
  CHECK(second->urgency == Urgency::edit);
}

TEST_CASE_METHOD(PlannerBench, "the urgency of a job that is made void returns to the chunk",
                 "[schedule]") {
  load_all();
  drain();
  commit({5, 5, 5}, 2);
  auto job = planner.next();
  REQUIRE(job);
  CHECK(job->urgency == Urgency::edit);
  planner.forget_meshes();
  CHECK_FALSE(finish(*job));
  job = planner.next();
  REQUIRE(job);
  CHECK(job->key.at == ChunkCoord{0, 0, 0});
  CHECK(job->urgency == Urgency::edit);
}

TEST_CASE_METHOD(PlannerBench,
                 "a chunk has one job at a time, and later changes are for the next job",
                 "[schedule]") {
  load_all();
  drain();
  commit({5, 5, 5}, 2);
  const auto first = planner.next();
  REQUIRE(first);
  commit({6, 6, 6}, 3);
  commit({7, 6, 6}, 3);
  CHECK(planner.dirty_count() == 1);
  CHECK(planner.ready_count() == 0);
  CHECK_FALSE(planner.next());
  CHECK(finish(*first));
  CHECK_FALSE(finish(*first));
  const MeshJob second = only();
  CHECK(second.before != nullptr);
  CHECK(second.changed.here == layers_of({{6, 6, 6}, {7, 6, 6}}));
  CHECK(planner.dirty_count() == 0);
}

TEST_CASE_METHOD(
    PlannerBench,
    "the result of a chunk that left the view, or whose neighbour left, is not drawn, even "
    "if it came back",
    "[schedule]") {
  load_all();
  std::map<ChunkCoord, MeshJob> jobs;
  while (auto job = planner.next()) jobs[job->key.at] = *job;
  replica.set_view({1, {3, 0, 0}, 2, 0});
  pass_changes();
  CHECK_FALSE(finish(jobs[{0, 0, 0}]));
  CHECK_FALSE(finish(jobs[{1, 0, 0}]));
  replica.set_view({1, {0, 0, 0}, 1, 0});
  load({0, 0, 0});
  CHECK_FALSE(finish(jobs[{0, 0, 0}]));
}

TEST_CASE_METHOD(
    PlannerBench,
    "when the view moves, chunks at its old and new edges are meshed again with what is beside them",
    "[schedule]") {
  load_all();
  drain();
  replica.set_view({1, {1, 0, 0}, 1, 0});
  pass_changes();
  planner.view_changed();
  CHECK(planner.dirty_count() == 1);  // (0, 0, 0), whose neighbours left
  load({1, 0, 1});
  load({1, 0, -1});
  CHECK(planner.dirty_count() == 4);  // both and (1, 0, 0), which had no neighbour there
  load({2, 0, 0});
  const auto order = drain();
  CHECK(std::set<ChunkCoord>(order.begin(), order.end()) ==
        std::set<ChunkCoord>{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {1, 0, -1}, {2, 0, 0}});
}

TEST_CASE_METHOD(PlannerBench,
                 "a chunk that waited for a neighbour is meshed when the neighbour leaves the view",
                 "[schedule]") {
  load({0, 0, 0});
  load({1, 0, 0});
  drain();
  CHECK(planner.dirty_count() == 1);
  replica.set_view({1, {0, 0, 0}, 0, 0});
  pass_changes();
  planner.view_changed();
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}});
}

TEST_CASE("the bound of a mesh's bytes counts the faces of shapes in each voxel",
          "[schedule][shapes]") {
  Shape bars;
  for (std::uint8_t i = 0; i < 32; ++i) {
    const auto x = static_cast<std::uint8_t>(i % 8 * 2 + 1);
    const auto z = static_cast<std::uint8_t>(i / 8 * 4 + 1);
    bars.boxes.push_back(
        {{x, 1, z}, {static_cast<std::uint8_t>(x + 1), 15, static_cast<std::uint8_t>(z + 1)}});
  }
  const ShapeTable shapes(
      std::vector<Shape>{{}, {}, {ShapeForm::boxes, {ShapeBox{{0, 0, 0}, {16, 8, 16}}}}, bars});
  const auto quads_about = [](RunChunk chunk, const ShapeTable& table) {
    MeshJob job;
    job.chunk = std::make_shared<const RunChunk>(std::move(chunk));
    return (mesh_bytes_about(job, table) - sizeof(ChunkMesh)) / sizeof(Quad);
  };
  const Extent extent = Extent::cube(32);
  CHECK(quads_about(uniform_chunk(extent, 1), shapes) == 3);
  CHECK(quads_about(uniform_chunk(extent, 2), ShapeTable{}) == 3);
  CHECK(quads_about(uniform_chunk(extent, 2), shapes) == 3 + 6 * extent.volume());
  RunChunk mixed = uniform_chunk(extent, 1);
  fill(mixed, 100, 7, 2);
  CHECK(quads_about(mixed, shapes) == 3 * 3 + 7 * 6);
  // Of more quads only the first ones are made.
  CHECK(quads_about(uniform_chunk(extent, 3), shapes) == 3 + kShapeQuadsMax);
}
