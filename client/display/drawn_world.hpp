// DrawnWorld: chunks that somebody hands over whole, meshed and on a screen. A change meshes the chunk again,
// and those neighbours whose touching layer sees it; nothing else. What a client's Replica, MeshPlanner and
// DrawThread are to a world that is played is this to one of which only pictures are wanted.
// One thread: that of the screen. Meshing is on the pool's threads while draw() waits for them.
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
#include "common/runs/run_chunk.hpp"

namespace runstone {

class DrawnWorld {
 public:
  /// Chunks held at most: a peer must not fill our memory with empty ones.
  static constexpr std::size_t kChunksMax = 1U << 18;

  /// `screen` must outlive the world. `edge`: voxels, of every chunk. `workers`: mesh threads; 0 meshes in
  /// draw() itself.
  DrawnWorld(Screen& screen, std::int32_t edge, const MaterialTable& materials, unsigned workers);

  /// Holds the chunk from now on. False if there are kChunksMax others. O(runs).
  bool put(const ChunkKey& key, RunChunk voxels);
  /// Nothing is known of the chunk any more: its neighbours show their faces towards it.
  void forget(const ChunkKey& key);
  std::size_t chunk_count() const { return chunks_.size(); }

  /// Meshes what changed, uploads it and draws. Throws std::runtime_error if the driver gave up.
  RenderStats draw(const Camera& camera, int width, int height);
  /// Meshes made so far.
  std::uint64_t meshes() const { return jobs_; }

 private:
  void mark_beside(const ChunkKey& key, Direction d);
  MeshJob job_for(const ChunkKey& key);
  void mesh_changes();

  Screen& screen_;
  const std::int32_t edge_;
  std::map<ChunkKey, ShownPtr> chunks_;
  std::set<ChunkKey> dirty_;  // held, and not meshed as they are now
  std::uint64_t jobs_ = 0;
  std::counting_semaphore<> results_{0};  // released by mesh threads
  MeshPool pool_;                         // its threads use what is above
};

}  // namespace runstone
