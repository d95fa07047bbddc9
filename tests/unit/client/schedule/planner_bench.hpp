// PlannerBench: a planner of a replica of a small world. The test meshes its jobs.
#pragma once
#include <catch2/catch.hpp>
#include <initializer_list>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "client/schedule/mesh_planner.hpp"
#include "tests/support/codec/authority_model.hpp"
#include "tests/support/codec/chunks_message.hpp"

namespace runstone::test {

inline constexpr std::int32_t kBenchEdge = 16;

/// Five chunks, all in view, and their planner.
struct PlannerBench {
  PlannerBench() {
    replica.set_view({1, {0, 0, 0}, 1, 0});  // a cross of five chunks
    static_cast<void>(replica.open({kBenchEdge, 5, 77, 1, 0, 0, 0}));
  }
  void load(ChunkCoord at) {
    replica.receive(chunks_of(world.snapshot(at)), {});
    pass_changes();
  }
  void load_all() {
    for (const ChunkCoord at : {ChunkCoord{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}})
      load(at);
  }
  void commit(VoxelPos at, Material material) {
    REQUIRE(replica.receive(world.commit({9, 1, ++edits}, {SetVoxel{at}, {}, material}), {})
                .has_value());
    pass_changes();
  }
  void pass_changes() { planner.take(replica.drain_changes().chunks); }
  /// Performs all jobs, each with its own mesh.
  std::vector<ChunkCoord> drain() {
    std::vector<ChunkCoord> out;
    while (auto job = planner.next()) {
      out.push_back(job->key.at);
      CHECK(finish(*job));
      last = made[job->key.at] = std::move(*job);
    }
    return out;
  }
  /// Performs the only job and returns it. Fails if there is none or another one.
  MeshJob only() {
    REQUIRE(drain().size() == 1);
    return last;
  }
  bool finish(const MeshJob& job) {
    auto mesh = std::make_shared<const ChunkMesh>();
    const bool drawn = planner.finish(job.key, job.number, mesh);
    if (drawn) meshes[job.key.at] = std::move(mesh);
    return drawn;
  }
  AuthorityModel world{kBenchEdge, 1};
  Replica replica;
  MeshPlanner planner{replica};
  MeshJob last;
  std::map<ChunkCoord, MeshJob> made;    // newest of each chunk
  std::map<ChunkCoord, MeshPtr> meshes;  // newest of each chunk
  ClientSequence edits = 0;
};

inline DirtyLayers layers_of(std::initializer_list<LocalPos> voxels) {
  DirtyLayers out;
  for (const LocalPos at : voxels) {
    out.layer[0].set(at.x);
    out.layer[1].set(at.y);
    out.layer[2].set(at.z);
  }
  return out;
}

}  // namespace runstone::test
