#include "client/schedule/mesh_pool.hpp"

#include <utility>

#include "common/runs/layer_diff.hpp"

namespace runstone {
namespace {

/// A scratch mesh of more quads is freed, so that no worker keeps the memory of a chunk of the
/// worst case.
constexpr std::size_t kScratchQuadsMax = 65'536;

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

MeshPool::MeshPool(VisibilityTable visibility, unsigned workers, ClockNs clock, Wake wake)
    : clock_(std::move(clock)),
      wake_(std::move(wake)),
      // The capacity is large enough that no worker is idle until the main thread pushes again, and
      // small enough that new work does not queue behind old work.
      capacity_(workers == 0 ? 1 : workers * 8),
      visibility_(std::make_shared<const VisibilityTable>(std::move(visibility))) {
  for (unsigned i = 0; i < workers; ++i) {
    threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
  }
}

MeshPool::~MeshPool() {
  for (std::jthread& thread : threads_) thread.request_stop();
  threads_.clear();
}

void MeshPool::set_visibility(VisibilityTable visibility) {
  auto next = std::make_shared<const VisibilityTable>(std::move(visibility));
  const std::lock_guard lock(mutex_);
  visibility_ = std::move(next);
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

std::vector<MeshResult> MeshPool::take_results() {
  const std::lock_guard lock(mutex_);
  in_flight_ -= results_.size();
  return std::exchange(results_, {});
}

std::size_t MeshPool::in_flight() const {
  const std::lock_guard lock(mutex_);
  return in_flight_;
}

void MeshPool::work(const std::stop_token& stop) {
  Scratch scratch;
  for (;;) {
    MeshJob job;
    std::shared_ptr<const VisibilityTable> visibility;
    {
      std::unique_lock lock(mutex_);
      if (!work_there_.wait(lock, stop, [this] { return !jobs_.empty(); }) || stop.stop_requested())
        return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
      visibility = visibility_;
    }
    MeshResult result = mesh(job, *visibility, scratch);
    {
      const std::lock_guard lock(mutex_);
      results_.push_back(std::move(result));
    }
    if (wake_) wake_();
  }
}

MeshResult MeshPool::mesh(const MeshJob& job, const VisibilityTable& visibility,
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
  }
  const std::int64_t start = clock_();
  if (job.before) {
    scratch.mesh = *job.before;
    result.layers_only = mesh_rdm_layers(*job.chunk, neighbours, visibility, job.changed.here,
                                         job.changed.beyond, scratch.rdm, scratch.mesh);
  } else {
    mesh_rdm(*job.chunk, neighbours, borders, visibility, scratch.rdm, scratch.mesh,
             &scratch.borders);
    if (!scratch.borders.empty())
      result.borders = std::make_shared<const ChunkBorders>(scratch.borders);
  }
  result.layers = result.layers_only ? layers_of(job) : all_layers(job.chunk->extent);
  result.mesh = scratch.mesh.empty() ? empty_ : std::make_shared<const ChunkMesh>(scratch.mesh);
  if (scratch.mesh.quad_count() > kScratchQuadsMax) scratch.mesh = {};
  const std::int64_t end = clock_();
  result.mesh_ns = end - start;
  result.meshed_us = end / 1000;
  return result;
}

}  // namespace runstone
