// MeshPool: threads that mesh chunks and tiles. One thread, the client's main thread, pushes jobs
// and takes results. At most `capacity` jobs wait or run. Beyond that, push() returns false, and
// the planner keeps the changes and merges them. Without workers push() meshes the job itself,
// which is for tests and machines with one core. Tiles are meshed while no chunk waits, and at
// least once for each kChunksPerTile chunks of a worker.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "client/far/tile_mesh.hpp"
#include "client/schedule/mesh_planner.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/chunk_mesher.hpp"
#include "common/mesh/mesh_materials.hpp"

namespace runstone {

struct MeshResult {
  ChunkKey key;
  std::uint64_t number = 0, serial = 0;  // of the job
  std::int32_t edge = 0;                 // voxels
  ShownPtr chunk;                        // the runs that were meshed
  MeshPtr mesh;                          // chunks without quads share one mesh
  BordersPtr borders;                    // of the chunk; null unless all of it was meshed
  bool layers_only = false;              // the other layers are those of the previous mesh
  Urgency urgency = Urgency::terrain;    // of the job
  std::uint8_t open_sides = 0;           // bit per Direction: there was no neighbour
  DirtyLayers layers;                    // that were meshed, of those in which a voxel changed
  std::int64_t mesh_ns = 0;              // duration
  TimeUs meshed_us = 0;                  // when meshing ended
};

class MeshPool {
 public:
  using ClockNs = std::function<std::int64_t()>;  // steady, nanoseconds; called from workers
  using Wake = std::function<void()>;             // called from a worker after each result

  MeshPool(MeshMaterialsPtr materials, unsigned workers, ClockNs clock, Wake wake);
  /// The materials are all cubes.
  MeshPool(const VisibilityTable& visibility, unsigned workers, ClockNs clock, Wake wake)
      : MeshPool(std::make_shared<const MeshMaterials>(visibility), workers, std::move(clock),
                 std::move(wake)) {}
  /// Drops the jobs that wait, and waits for the running ones.
  ~MeshPool();
  MeshPool(const MeshPool&) = delete;
  MeshPool& operator=(const MeshPool&) = delete;

  /// Replaces the materials, for the jobs that begin from now on.
  void set_materials(MeshMaterialsPtr materials);
  bool push(MeshJob job);
  /// Meshes on the calling thread. Thread: the one that pushes.
  MeshResult mesh_here(const MeshJob& job) { return mesh(job, *materials_, push_scratch_); }
  /// Returns the results so far, in the order in which they were finished.
  std::vector<MeshResult> take_results();
  /// Returns the number of jobs that wait or run, plus the results that were not taken.
  std::size_t in_flight() const;
  std::size_t capacity() const { return capacity_; }

  /// Queues a tile. Returns false if kTilesPerWorker of each worker wait or run.
  bool push(FarMeshJob job);
  std::vector<FarMeshResult> take_tiles();
  /// Returns the number of tiles that wait or run, plus the results that were not taken.
  std::size_t tiles_in_flight() const;
  bool has_room_for_tiles() const { return tiles_in_flight() < tiles_max_; }

  static constexpr std::size_t kTilesPerWorker = 4;
  static constexpr unsigned kChunksPerTile = 8;

 private:
  struct Scratch {
    ChunkMeshScratch mesher;
    // For meshes of whole chunks. Their capacities grow; the results are copies of the right size.
    ChunkMesh mesh;
    ChunkBorders borders;
  };
  using Job = std::variant<MeshJob, FarMeshJob>;
  void work();
  /// Takes the job that comes next. Requires that one waits, and mutex_.
  Job take_job(unsigned& chunks_since_tile);
  MeshResult mesh(const MeshJob& job, const MeshMaterials& materials, Scratch& scratch) const;

  const ClockNs clock_;
  const Wake wake_;
  const std::size_t capacity_, tiles_max_;
  const MeshPtr empty_ = std::make_shared<const ChunkMesh>();
  mutable std::mutex mutex_;
  // Never null. The thread that pushes replaces it, under mutex_. Workers copy it under mutex_.
  MeshMaterialsPtr materials_;
  std::condition_variable work_there_;
  std::deque<MeshJob> jobs_;  // guarded by mutex_, as are the next six
  std::deque<FarMeshJob> tile_jobs_;
  std::vector<MeshResult> results_;
  std::vector<FarMeshResult> tile_results_;
  std::size_t in_flight_ = 0;
  std::size_t tiles_in_flight_ = 0;
  bool stops_ = false;
  Scratch push_scratch_;  // used by the thread that pushes
  std::vector<std::thread> threads_;
};

}  // namespace runstone
