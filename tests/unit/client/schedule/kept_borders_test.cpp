#include "client/schedule/kept_borders.hpp"

#include <catch2/catch.hpp>
#include <memory>

#include "common/runs/run_chunk.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/unit/client/schedule/planner_bench.hpp"

namespace runstone::test {
namespace {

constexpr ChunkKey kHere{0, {1, 2, 3}};

ShownPtr chunk_with_voxel() {
  RunChunk chunk = uniform_chunk(Extent::cube(kBenchEdge), kEmpty);
  fill(chunk, 7, 1, kStone);
  return std::make_shared<const RunChunk>(std::move(chunk));
}

BordersPtr borders_of(const RunChunk& chunk) {
  auto borders = std::make_shared<ChunkBorders>();
  borders->read(chunk, mesh_visibility());
  return borders;
}

TEST_CASE("kept borders are found for the runs that they were made from, and for no others",
          "[schedule]") {
  KeptBorders kept;
  const ShownPtr chunk = chunk_with_voxel();
  const BordersPtr borders = borders_of(*chunk);
  CHECK(kept.find(kHere, chunk) == nullptr);
  kept.keep(kHere, chunk, borders);
  CHECK(kept.find(kHere, chunk) == borders);
  CHECK(kept.find(kHere, chunk_with_voxel()) == nullptr);
  CHECK(kept.find(kHere, nullptr) == nullptr);
  CHECK(kept.find({0, {1, 2, 4}}, chunk) == nullptr);
}

TEST_CASE("kept borders are not found once their runs are gone", "[schedule]") {
  KeptBorders kept;
  ShownPtr chunk = chunk_with_voxel();
  kept.keep(kHere, chunk, borders_of(*chunk));
  chunk.reset();
  CHECK(kept.find(kHere, nullptr) == nullptr);
}

TEST_CASE("the size of kept borders follows what is replaced and erased", "[schedule]") {
  KeptBorders kept;
  const ShownPtr chunk = chunk_with_voxel();
  const BordersPtr borders = borders_of(*chunk);
  const std::size_t one = sizeof(ChunkBorders) + borders->byte_size();
  kept.keep(kHere, chunk, borders);
  kept.keep(kHere, chunk, borders);
  CHECK(kept.bytes() == one);
  kept.keep({0, {0, 0, 0}}, chunk, borders);
  CHECK(kept.bytes() == 2 * one);
  kept.erase(kHere);
  kept.erase(kHere);
  CHECK(kept.bytes() == one);
  kept.keep({0, {0, 0, 0}}, chunk, nullptr);
  CHECK(kept.bytes() == 0);
  kept.keep(kHere, chunk, borders);
  kept.clear();
  CHECK(kept.bytes() == 0);
  CHECK(kept.find(kHere, chunk) == nullptr);
}

TEST_CASE_METHOD(PlannerBench, "a job has the borders that earlier meshes beside it made",
                 "[schedule]") {
  load_all();
  commit({5, 5, 5}, 2);
  auto middle = planner.next();
  REQUIRE(middle);
  REQUIRE(middle->key.at == ChunkCoord{0, 0, 0});
  const BordersPtr borders = borders_of(*middle->chunk);
  REQUIRE(planner.finish(middle->key, middle->number, std::make_shared<const ChunkMesh>(),
                         middle->chunk, borders));
  drain();
  const auto seen_from_beside = [this] {
    commit({kBenchEdge + 5, 5, 5}, static_cast<Material>(2 + edits));
    return only().borders[static_cast<std::size_t>(Direction::neg_x)];
  };
  CHECK(seen_from_beside() == borders);
  SECTION("until the chunk changes") { commit({6, 5, 5}, 2); }
  SECTION("until all materials look different") { planner.forget_meshes(); }
  SECTION("until one of its materials does") { planner.mesh_again_from(2); }
  SECTION("until the chunk has left the view") {
    replica.set_view({2, {1, 0, 0}, 0, 0});
    pass_changes();
    replica.set_view({3, {0, 0, 0}, 1, 0});
    load_all();
  }
  drain();
  CHECK(seen_from_beside() == nullptr);
}

TEST_CASE_METHOD(PlannerBench, "borders of runs that changed during the mesh are not kept",
                 "[schedule]") {
  load_all();
  commit({5, 5, 5}, 2);
  const auto job = planner.next();
  REQUIRE(job);
  commit({6, 5, 5}, 2);
  const std::size_t before = planner.kept_bytes();
  REQUIRE(planner.finish(job->key, job->number, std::make_shared<const ChunkMesh>(), job->chunk,
                         borders_of(*job->chunk)));
  CHECK(planner.kept_bytes() == before);
}

}  // namespace
}  // namespace runstone::test
