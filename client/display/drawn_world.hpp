// DrawnWorld: the world of the draw program. It receives whole chunks, meshes them and uploads them
// to a screen. A changed chunk is meshed again, together with each neighbour that touches a changed
// border layer. In the normal client, Replica, MeshPlanner and DrawThread do this work. Thread:
// that of the screen. The pool's threads mesh while draw() waits for them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <semaphore>
#include <set>

#include "client/display/screen.hpp"
#include "client/schedule/mesh_pool.hpp"
#include "common/core/coords.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/mesh_materials.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

class DrawnWorld {
 public:
  /// The greatest number of chunks. It prevents a peer from filling the memory with empty chunks.
  static constexpr std::size_t kChunksMax = 1U << 18;

  /// `screen` must outlive the world. `edge` is the edge of every chunk in voxels. `workers` is the
  /// number of mesh threads; with 0, draw() meshes itself.
  DrawnWorld(Screen& screen, std::int32_t edge, const MaterialTable& materials, unsigned workers);

  /// Stores or replaces the chunk. Returns false if the chunk is new and kChunksMax are stored.
  /// Cost: O(runs).
  bool put(const ChunkKey& key, RunChunk voxels);
  /// Removes the chunk. Its neighbours then show their faces towards it.
  void forget(const ChunkKey& key);
  std::size_t chunk_count() const { return chunks_.size(); }

  /// Meshes and uploads the changed chunks, and draws. Throws std::runtime_error if the driver
  /// fails.
  RenderStats draw(const Camera& camera, int width, int height);
  /// Returns the number of meshes made so far.
  std::uint64_t meshes() const { return jobs_; }

 private:
  DrawnWorld(Screen& screen, std::int32_t edge, const MaterialTable& materials,
             const MeshMaterialsPtr& meshed, unsigned workers);
  void mark_beside(const ChunkKey& key, Direction d);
  MeshJob job_for(const ChunkKey& key);
  void mesh_changes();

  Screen& screen_;
  const std::int32_t edge_;
  std::map<ChunkKey, ShownPtr> chunks_;
  std::set<ChunkKey> dirty_;  // stored, and changed since they were last meshed
  std::uint64_t jobs_ = 0;
  std::counting_semaphore<> results_{0};  // released by mesh threads
  MeshPool pool_;                         // last: its threads use the members above
};

}  // namespace runstone
