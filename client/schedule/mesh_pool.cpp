#include "client/schedule/mesh_pool.hpp"

#include <utility>

#include "common/runs/layer_diff.hpp"

namespace runstone {
namespace {

/// A scratch mesh of more quads is freed, so that no worker keeps the memory of a chunk of the
/// worst case.
constexpr std::size_t kScratchQuadsMax = 65'536;

/// The room of a pass for the quads that an edit adds. Few edits of a hand add more.
constexpr std::size_t kQuadRoom = 64;

/// Replaces `to` by a copy of `from`, with room for more quads if there are any.
void copy_with_room(const QuadLayers& from, QuadLayers& to) {
  if (!from.quads.empty()) to.quads.reserve(from.quads.size() + kQuadRoom);
  to = from;
}

/// Returns true if little of the memory of a pass is unused.
bool fits_memory(const QuadLayers& layers) {
  return layers.quads.capacity() <= layers.quads.size() + 2 * kQuadRoom;
}

/// Returns the layers that a job meshes because a voxel in them or beside them changed.
DirtyLayers layers_of(const MeshJob& job) {
  DirtyLayers out = job.changed.here;
  for (std::size_t i = 0; i < job.changed.beyond.size(); ++i) {
    if (!job.changed.beyond[i].any()) continue;
    const auto d = static_cast<Direction>(i);
    const auto axis = static_cast<std::size_t>(axis_of(d));
    out.layer[axis].set(is_positive(d) ? job.chunk->extent.sides()[axis] - 1U : 0U);
  }
  return out;
}

}  // namespace

MeshPool::MeshPool(MeshMaterialsPtr materials, unsigned workers, ClockNs clock, Wake wake)
    : clock_(std::move(clock)),
      wake_(std::move(wake)),
      // The capacity is large enough that no worker is idle until the main thread pushes again, and
      // small enough that new work does not queue behind old work.
      capacity_(workers == 0 ? 1 : workers * 8),
      tiles_max_(workers == 0 ? 1 : workers * kTilesPerWorker),
      materials_(std::move(materials)) {
  for (unsigned i = 0; i < workers; ++i) threads_.emplace_back([this] { work(); });
}

MeshPool::~MeshPool() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  work_there_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void MeshPool::set_materials(MeshMaterialsPtr materials) {
  const std::lock_guard lock(mutex_);
  materials_ = std::move(materials);
}

bool MeshPool::push(MeshJob job) {
  if (threads_.empty()) {
    MeshResult result = mesh_here(job);
    const std::lock_guard lock(mutex_);
    ++in_flight_;
    results_.push_back(std::move(result));
    return true;
  }
  {
    const std::lock_guard lock(mutex_);
    if (in_flight_ >= capacity_) return false;
    ++in_flight_;
    jobs_.push_back(std::move(job));
  }
  work_there_.notify_one();
  return true;
}

bool MeshPool::push(FarMeshJob job) {
  if (threads_.empty()) {
    FarMeshResult result = mesh_tile(job, materials_->tiles, push_scratch_.mesher.cubes);
    const std::lock_guard lock(mutex_);
    ++tiles_in_flight_;
    tile_results_.push_back(std::move(result));
    return true;
  }
  {
    const std::lock_guard lock(mutex_);
    if (tiles_in_flight_ >= tiles_max_) return false;
    ++tiles_in_flight_;
    tile_jobs_.push_back(std::move(job));
  }
  work_there_.notify_one();
  return true;
}

std::vector<FarMeshResult> MeshPool::take_tiles() {
  const std::lock_guard lock(mutex_);
  tiles_in_flight_ -= tile_results_.size();
  return std::exchange(tile_results_, {});
}

std::size_t MeshPool::tiles_in_flight() const {
  const std::lock_guard lock(mutex_);
  return tiles_in_flight_;
}

std::vector<MeshResult> MeshPool::take_results() {
  const std::lock_guard lock(mutex_);
  in_flight_ -= results_.size();
  return std::exchange(results_, {});
}

std::size_t MeshPool::in_flight() const {
  const std::lock_guard lock(mutex_);
  return in_flight_;
}

MeshPool::Job MeshPool::take_job(unsigned& chunks_since_tile) {
  const bool is_tile =
      !tile_jobs_.empty() && (jobs_.empty() || chunks_since_tile >= kChunksPerTile);
  if (is_tile) {
    chunks_since_tile = 0;
    Job out = std::move(tile_jobs_.front());
    tile_jobs_.pop_front();
    return out;
  }
  ++chunks_since_tile;
  Job out = std::move(jobs_.front());
  jobs_.pop_front();
  return out;
}

void MeshPool::work() {
  Scratch scratch;
  unsigned chunks_since_tile = 0;
  for (;;) {
    Job job;
    MeshMaterialsPtr materials;
    {
      std::unique_lock lock(mutex_);
      work_there_.wait(lock, [this] { return stops_ || !jobs_.empty() || !tile_jobs_.empty(); });
      if (stops_) return;
      job = take_job(chunks_since_tile);
      materials = materials_;
    }
    if (const auto* const tile = std::get_if<FarMeshJob>(&job)) {
      FarMeshResult result = mesh_tile(*tile, materials->tiles, scratch.mesher.cubes);
      const std::lock_guard lock(mutex_);
      tile_results_.push_back(std::move(result));
    } else {
      MeshResult result = mesh(std::get<MeshJob>(job), *materials, scratch);
      const std::lock_guard lock(mutex_);
      results_.push_back(std::move(result));
    }
    if (wake_) wake_();
  }
}

MeshResult MeshPool::mesh(const MeshJob& job, const MeshMaterials& materials,
                          Scratch& scratch) const {
  MeshResult result;
  result.key = job.key;
  result.number = job.number;
  result.serial = job.serial;
  result.edge = job.chunk->extent.x;
  result.chunk = job.chunk;
  result.urgency = job.urgency;
  MeshNeighbours neighbours{};
  MeshBorders borders{};
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    neighbours[i] = job.neighbours[i].get();
    borders[i] = job.borders[i].get();
    if (neighbours[i] == nullptr)
      result.open_sides = static_cast<std::uint8_t>(result.open_sides | 1U << i);
  }
  const std::int64_t start = clock_();
  if (job.before) {
    // The copy becomes the result, so the quads are not copied a second time.
    const auto mesh = std::make_shared<ChunkMesh>();
    copy_with_room(job.before->opaque, mesh->opaque);
    copy_with_room(job.before->transparent, mesh->transparent);
    result.layers_only =
        mesh_chunk_layers(*job.chunk, neighbours, borders, materials, job.changed.here,
                          job.changed.beyond, scratch.mesher, *mesh);
    const bool is_fitting =
        result.layers_only && fits_memory(mesh->opaque) && fits_memory(mesh->transparent);
    result.mesh = mesh->empty() ? empty_
                  : is_fitting  ? mesh
                                : std::make_shared<const ChunkMesh>(*mesh);
  } else {
    mesh_chunk(*job.chunk, neighbours, borders, materials, scratch.mesher, scratch.mesh,
               &scratch.borders);
    if (!scratch.borders.empty())
      result.borders = std::make_shared<const ChunkBorders>(scratch.borders);
    result.mesh = scratch.mesh.empty() ? empty_ : std::make_shared<const ChunkMesh>(scratch.mesh);
    if (scratch.mesh.quad_count() > kScratchQuadsMax) scratch.mesh = {};
  }
  result.layers = result.layers_only ? layers_of(job) : all_layers(job.chunk->extent);
  const std::int64_t end = clock_();
  result.mesh_ns = end - start;
  result.meshed_us = end / 1000;
  return result;
}

}  // namespace runstone
