#include "client/display/drawn_world.hpp"

#include <memory>
#include <utility>

#include "common/core/assert.hpp"
#include "common/mesh_materials/mesh_materials_of.hpp"
#include "common/os/steady_clock.hpp"
#include "common/runs/layer_diff.hpp"

namespace runstone {
namespace {

ChunkKey beside(const ChunkKey& key, Direction d) { return {key.lod, neighbour(key.at, d)}; }

}  // namespace

DrawnWorld::DrawnWorld(Screen& screen, std::int32_t edge, const MaterialTable& materials,
                       unsigned workers)
    : DrawnWorld(screen, edge, materials, mesh_materials_of(materials), workers) {}

DrawnWorld::DrawnWorld(Screen& screen, std::int32_t edge, const MaterialTable& materials,
                       const MeshMaterialsPtr& meshed, unsigned workers)
    : screen_(screen),
      edge_(edge),
      pool_(meshed, workers, steady_now_ns, [this] { results_.release(); }) {
  screen_.set_materials(materials, shapes_in(meshed));
}

bool DrawnWorld::put(const ChunkKey& key, RunChunk voxels) {
  RUNSTONE_ASSERT(voxels.extent == Extent::cube(static_cast<unsigned>(edge_)));
  const auto held = chunks_.find(key);
  if (held == chunks_.end() && chunks_.size() == kChunksMax) return false;
  const DirtyLayers dirty =
      held == chunks_.end() ? all_layers(voxels.extent) : changed_layers(*held->second, voxels);
  if (!dirty.any()) return true;
  for (int i = 0; i < kDirectionCount; ++i) {
    const auto d = static_cast<Direction>(i);
    if (border_dirty(dirty, d, static_cast<unsigned>(edge_))) mark_beside(key, d);
  }
  dirty_.insert(key);
  chunks_.insert_or_assign(key, std::make_shared<const RunChunk>(std::move(voxels)));
  return true;
}

void DrawnWorld::forget(const ChunkKey& key) {
  if (chunks_.erase(key) == 0) return;
  dirty_.erase(key);
  screen_.remove(key);
  for (int i = 0; i < kDirectionCount; ++i) mark_beside(key, static_cast<Direction>(i));
}

void DrawnWorld::mark_beside(const ChunkKey& key, Direction d) {
  const ChunkKey next = beside(key, d);
  if (chunks_.contains(next)) dirty_.insert(next);
}

MeshJob DrawnWorld::job_for(const ChunkKey& key) {
  const auto held = [this](const ChunkKey& k) {
    const auto found = chunks_.find(k);
    return found == chunks_.end() ? nullptr : found->second;
  };
  MeshJob job;
  job.key = key;
  job.number = ++jobs_;
  job.chunk = held(key);
  for (std::size_t i = 0; i < job.neighbours.size(); ++i) {
    job.neighbours[i] = held(beside(key, static_cast<Direction>(i)));
  }
  return job;
}

void DrawnWorld::mesh_changes() {
  while (!dirty_.empty() || pool_.in_flight() != 0) {
    while (!dirty_.empty() && pool_.in_flight() < pool_.capacity()) {
      pool_.push(job_for(*dirty_.begin()));
      dirty_.erase(dirty_.begin());
    }
    for (const MeshResult& result : pool_.take_results())
      screen_.upload(result.key, result.edge, *result.mesh, result.chunk.get());
    if (pool_.in_flight() == 0) continue;
    // Each job in flight releases the semaphore once, after it has queued its result, so this wait
    // ends. The loop takes further releases whose results the next turn takes as well.
    results_.acquire();
    while (results_.try_acquire()) {
    }
  }
}

RenderStats DrawnWorld::draw(const Camera& camera, int width, int height) {
  mesh_changes();
  return screen_.draw(camera, width, height, {});
}

}  // namespace runstone
