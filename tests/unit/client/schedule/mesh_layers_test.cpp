// A planner plans to mesh again either the layers that changed or the whole chunk.
#include <catch2/catch.hpp>
#include <set>

#include "client/schedule/mesh_planner.hpp"
#include "common/runs/reorder.hpp"
#include "tests/unit/client/schedule/planner_bench.hpp"

using namespace runstone;
using test::kBenchEdge;
using test::layers_of;
using test::PlannerBench;

namespace {

const ChunkKey kHere{0, {0, 0, 0}}, kRight{0, {1, 0, 0}};
constexpr auto kFromLeft = static_cast<std::size_t>(Direction::neg_x);

}  // namespace

TEST_CASE_METHOD(PlannerBench,
                 "the first mesh is of the whole chunk, and that of an edit is of its layers",
                 "[schedule]") {
  load_all();
  while (auto job = planner.next()) {
    CHECK(job->before == nullptr);
    CHECK(finish(*job));
  }
  const MeshPtr loaded = meshes[{0, 0, 0}];
  commit({5, 6, 7}, 2);
  commit({5, 6, 9}, 2);
  const MeshJob job = only();
  CHECK(job.before == loaded);
  CHECK(job.changed.here == layers_of({{5, 6, 7}, {5, 6, 9}}));
  CHECK(job.changed.beyond == ChangedLayers{}.beyond);
  commit({1, 1, 1}, 2);
  CHECK(only().changed.here ==
        layers_of({{1, 1, 1}}));  // these layers are not in the previous mesh any more
}

TEST_CASE_METHOD(PlannerBench, "an edit at the border is a change of the neighbour, too",
                 "[schedule]") {
  load_all();
  drain();
  commit({15, 6, 7}, 2);
  commit({3, 3, 3}, 2);  // not at the border: no change of the neighbour
  const MeshPtr before = meshes[kRight.at];
  REQUIRE(drain() == std::vector<ChunkCoord>{{0, 0, 0}, {1, 0, 0}});
  CHECK(last.before == before);
  CHECK_FALSE(last.changed.here.any());
  ChangedLayers expected;
  expected.beyond[kFromLeft] = layers_of({{15, 6, 7}});
  CHECK(last.changed == expected);
}

TEST_CASE_METHOD(PlannerBench,
                 "a removed prediction changes the layers that it had changed, meshed or not",
                 "[schedule]") {
  load_all();
  drain();
  const bool meshed = GENERATE(false, true);
  const auto seq = replica.predict({SetVoxel{{15, 6, 7}}, {}, 2}, 0, 0);
  REQUIRE(seq);
  pass_changes();
  if (meshed) drain();
  replica.receive(Reject{*seq, RejectReason::rate_limited, "", 0}, 0);
  pass_changes();
  REQUIRE(drain() == std::vector<ChunkCoord>{{0, 0, 0}, {1, 0, 0}});
  CHECK(last.before != nullptr);
  CHECK(last.changed.beyond[kFromLeft] == layers_of({{15, 6, 7}}));
}

TEST_CASE_METHOD(PlannerBench, "a snapshot that repairs a chunk changes the layers that differ",
                 "[schedule]") {
  load_all();
  drain();
  static_cast<void>(world.commit({9, 1, ++edits}, {SetVoxel{{4, 5, 6}}, {}, 2}));  // never arrives
  load(kHere.at);
  const MeshJob job = only();
  CHECK(job.before != nullptr);
  CHECK(job.changed.here == layers_of({{4, 5, 6}}));
}

TEST_CASE_METHOD(PlannerBench, "a chunk in another axis order is meshed as a whole", "[schedule]") {
  load_all();
  drain();
  const Material material =
      GENERATE(Material{2}, kEmpty);  // kEmpty: no voxel differs, and nothing changes
  static_cast<void>(world.commit({9, 1, ++edits}, {SetVoxel{{4, 5, 6}}, {}, material}));
  ChunkSnapshot turned = world.snapshot(kHere.at);
  const bool was_zyx = turned.chunk.voxels.order == AxisOrder::zyx;
  turned.chunk.voxels = reorder(turned.chunk.voxels, was_zyx ? AxisOrder::xyz : AxisOrder::zyx);
  replica.receive(test::chunks_of(std::move(turned)), {});
  pass_changes();
  CHECK(planner.dirty_count() ==
        (material == kEmpty ? 0 : 5));  // the layers that differ are unknown
  commit({1, 1, 1}, 2);
  drain();
  CHECK(made[kHere.at].before == nullptr);
  CHECK(made[kHere.at].chunk->order != made[kRight.at].chunk->order);
  commit({1, 1, 2}, 2);
  CHECK(only().before != nullptr);
}

TEST_CASE_METHOD(PlannerBench,
                 "a chunk whose neighbour arrived, left or returned is meshed as a whole",
                 "[schedule]") {
  load_all();
  drain();
  SECTION("unavailable: the server cannot send it") {
    static_cast<void>(replica.open({kBenchEdge, 5, 77, 1, 0, 0, 0}));
    replica.receive(ChunkUnavailable{1, {kRight}, UnavailableReason::damaged});
    pass_changes();
    CHECK(only().before == nullptr);
    CHECK(last.key == kHere);
    load(kRight.at);  // arrived
    REQUIRE(drain() == std::vector<ChunkCoord>{{0, 0, 0}, {1, 0, 0}});
    CHECK(last.before == nullptr);
  }
  SECTION("returned, with other voxels at the border") {
    const bool drains_between = GENERATE(false, true);
    replica.set_view({2, {-1, 0, 0}, 1, 0});
    if (drains_between) {
      pass_changes();
      CHECK(only().key == kHere);  // left
      CHECK(last.before == nullptr);
    }
    CHECK(planner.next() == std::nullopt);
    static_cast<void>(world.commit({9, 1, ++edits}, {SetVoxel{{16, 5, 6}}, {}, 2}));
    replica.set_view({3, {0, 0, 0}, 1, 0});
    for (const ChunkCoord at : {kRight.at, ChunkCoord{0, 0, 1}, {0, 0, -1}}) {
      replica.receive(test::chunks_of(world.snapshot(at), 3), {});
    }
    pass_changes();
    const auto order = drain();
    CHECK(std::set<ChunkCoord>(order.begin(), order.end()) ==
          std::set<ChunkCoord>{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, -1}});
    for (const ChunkCoord at : order) CHECK(made[at].before == nullptr);
  }
}

TEST_CASE_METHOD(PlannerBench,
                 "with changes that were not taken yet the chunk is meshed as a whole",
                 "[schedule]") {
  load_all();
  drain();
  commit({5, 5, 5}, 2);
  REQUIRE(
      replica.receive(world.commit({9, 1, ++edits}, {SetVoxel{{6, 6, 6}}, {}, 2}), {}).has_value());
  CHECK(only().before == nullptr);
  pass_changes();
  CHECK(only().before != nullptr);
}

TEST_CASE_METHOD(PlannerBench,
                 "after forget_meshes() everything is meshed again, and open jobs are void",
                 "[schedule]") {
  load_all();
  const auto out = planner.next();
  REQUIRE(out);
  drain();
  planner.forget_meshes();
  CHECK_FALSE(finish(*out));
  CHECK(planner.kept_bytes() == 0);
  CHECK(planner.dirty_count() == 5);
  while (auto job = planner.next()) {
    CHECK(job->before == nullptr);
    CHECK(finish(*job));
  }
  CHECK(meshes.size() == 5);
}

TEST_CASE_METHOD(PlannerBench, "kept meshes cost eight bytes per quad and the index of layers",
                 "[schedule]") {
  load_all();
  drain();
  CHECK(planner.kept_bytes() == 0);  // chunks without quads share one mesh
  commit({5, 5, 5}, 2);
  const auto job = planner.next();
  REQUIRE(job);
  auto mesh = std::make_shared<ChunkMesh>();
  mesh->opaque.quads.resize(6);
  REQUIRE(planner.finish(job->key, job->number, std::move(mesh)));
  CHECK(planner.kept_bytes() == 6 * 8 + sizeof(ChunkMesh));
}
