#include "client/display/mesh_pipeline.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "client/display/eye_chunk.hpp"
#include "common/core/assert.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {

namespace {

/// Returns the first material that differs between two tables, or that one of them lacks.
std::size_t first_difference(std::span<const MaterialInfo> a, std::span<const MaterialInfo> b) {
  return static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first -
                                  a.begin());
}

}  // namespace

MeshPipeline::MeshPipeline(const Replica& replica, DrawQueue* draw_queue, bool watched,
                           unsigned workers, std::function<void()> wake)
    : watched_(watched),
      workers_(workers),
      wake_(std::move(wake)),
      recorder_(draw_queue != nullptr ? LatencyStage::presented : LatencyStage::meshed),
      replica_(replica),
      planner_(replica),
      far_planner_(replica.far_tiles()),
      look_(!watched),
      draw_queue_(draw_queue) {}

void MeshPipeline::set_materials(const MaterialTable& materials, MeshMaterialsPtr meshed) {
  if (pool_ && materials_ == materials) return;
  // A chunk whose materials all lie before the first difference looks the same with both tables,
  // whatever world they are of. So its mesh stays. A table that lost rows makes all meshes anew.
  const std::size_t known = first_difference(materials.rows(), materials_.rows());
  const bool keeps_meshes = pool_ && known > 0 && materials.size() >= materials_.size();
  materials_ = materials;
  changed_ = true;
  meshed_ = std::move(meshed);
  if (draw_queue_) draw_queue_->set_materials(materials_, shapes_in(meshed_));
  far_planner_.set_visibility(meshed_->cubes,
                              keeps_meshes ? static_cast<Material>(known) : Material{0});
  if (keeps_meshes) {
    pool_->set_materials(meshed_);
    return planner_.mesh_again_from(static_cast<Material>(known));
  }
  planner_.forget_meshes();
  pool_.reset();
  open_job_bytes_.clear();
  pool_ = std::make_unique<MeshPool>(meshed_, workers_, steady_now_ns, wake_);
}

void MeshPipeline::take(const ReplicaChanges& changes, const ClockOffset& clock, TimeUs now_us) {
  recorder_.take(changes, clock, now_us);
  planner_.take(changes.chunks);
  for (const auto& [key, reason] : changes.unavailable) join_.done(key, now_us);
  far_planner_.take(changes.tiles);
  for (const ChunkChange& chunk : changes.chunks) {
    far_planner_.set_chunk(chunk.key.at, !chunk.removed);
    if (!chunk.removed || !draw_queue_) continue;
    draw_queue_->remove(chunk.key);
    tracker_.removed(chunk.key);
    gpu_bytes_.erase(chunk.key);
    changed_ = true;
  }
}

void MeshPipeline::take_drawn() {
  if (!draw_queue_) return;
  // The draw thread reports in order: a frame presents the uploads before it and none after it.
  for (const DrawDone& done : draw_queue_->take_done()) {
    if (const auto* upload = std::get_if<UploadDone>(&done)) {
      tracker_.uploaded(upload->key, upload->number);
      if (upload->key.lod > 0) continue;
      recorder_.uploaded(upload->key, upload->serial, upload->at_us);
    }
    if (const auto* frame = std::get_if<FrameDone>(&done)) take_frame(*frame);
  }
}

void MeshPipeline::take_frame(const FrameDone& frame) {
  tracker_.presented();
  recorder_.presented(frame.presented_us);
  ++frames_.presented;
  frames_.upload_us.add(frame.upload_us);
  last_frame_us_ = frame.presented_us - frame.started_us;
  frames_.draw_us.add(last_frame_us_);
  if (measures_frames_) look_.frame_took(last_frame_us_);
  recent_frames_.push_back(frame);
  if (recent_frames_.size() > kRecentFramesMax) recent_frames_.pop_front();
  if (frame_.screenshots) {
    screenshots_written_ = {};
    if (!frame.unwritten.empty()) screenshots_written_ = failure(frame.unwritten.front());
  }
  frame_ = {};
  if (!watched_ && !is_unpaced_) next_frame_us_ = frame.presented_us + kFrameOffScreenUs;
  unwritten_.insert(unwritten_.end(), frame.unwritten.begin(), frame.unwritten.end());
}

void MeshPipeline::mesh() {
  if (!pool_) return;
  take_results();
  mesh_layers();
  push_jobs();
  push_tiles();
}

void MeshPipeline::take_results() {
  for (MeshResult& result : pool_->take_results()) take_result(std::move(result));
}

void MeshPipeline::take_result(MeshResult result) {
  (result.layers_only ? layers_ns_ : whole_ns_).add(result.mesh_ns);
  open_job_bytes_.erase(result.number);
  if (!planner_.finish(result.key, result.number, result.mesh, result.chunk,
                       std::move(result.borders)))
    return;
  recorder_.meshed(result.key, result.serial, result.meshed_us);
  join_.done(result.key, result.meshed_us);
  if (!draw_queue_) return;
  const bool has_walls = result.open_sides != 0 && !result.mesh->transparent.quads.empty();
  if (has_walls && replica_.far_tiles().solid_count() != 0) {
    ChunkMesh mesh = *result.mesh;
    if (drop_water_walls(mesh, result.edge, result.open_sides))
      result.mesh = std::make_shared<const ChunkMesh>(std::move(mesh));
  }
  gpu_bytes_.set(result.key, runstone::gpu_bytes(*result.mesh, result.chunk.get()));
  inspection_.meshed(result, result.meshed_us);
  tracker_.queued(result.key, result.number, result.urgency);
  draw_queue_->upload(result.key, {result.number, result.serial, result.edge, result.urgency,
                                   std::move(result.mesh), std::move(result.chunk), nullptr});
}

void MeshPipeline::mesh_layers() {
  for (const TimeUs until_us = steady_now_us() + kMeshHereUs; steady_now_us() < until_us;) {
    const auto job = planner_.next(JobSize::layers);
    if (!job) return;
    take_result(pool_->mesh_here(*job));
  }
}

void MeshPipeline::push_jobs() {
  while (pool_->in_flight() < pool_->capacity() && has_room_for_jobs()) {
    auto job = planner_.next();
    if (!job) return;
    const std::size_t bytes = mesh_bytes_about(*job, meshed_->shapes);
    open_job_bytes_.set(job->number, (draw_queue_ ? 2 : 1) * bytes);
    pool_->push(std::move(*job));
  }
}

void MeshPipeline::push_tiles() {
  for (FarMeshResult& result : pool_->take_tiles()) take_tile(std::move(result));
  for (const ChunkKey& key : far_planner_.take_removals()) {
    if (!draw_queue_) continue;
    draw_queue_->remove(key);
    tracker_.removed(key);
    far_gpu_bytes_.erase(key);
    changed_ = true;
  }
  while (pool_->has_room_for_tiles()) {
    auto job = far_planner_.next();
    if (!job) return;
    if (is_empty(*job->tile)) {
      take_tile({job->key, job->number, job->tile->extent.x, std::make_shared<const TileMesh>()});
    } else {
      pool_->push(std::move(*job));
    }
  }
}

void MeshPipeline::take_tile(FarMeshResult result) {
  if (!far_planner_.finish(result.key, result.number) || !draw_queue_) return;
  far_gpu_bytes_.set(result.key, runstone::gpu_bytes(*result.mesh));
  tracker_.queued(result.key, result.number, Urgency::terrain);
  ChunkUpload upload;
  upload.number = result.number;
  upload.edge = result.edge;
  upload.tile = std::move(result.mesh);
  draw_queue_->upload(result.key, std::move(upload));
}

bool MeshPipeline::has_room_for_jobs() const {
  return pool_->in_flight() == 0 ||
         mesh_bytes() + gpu_bytes() + open_job_bytes_.total() < mesh_bytes_max_;
}

bool MeshPipeline::is_screenshot_due(TimeUs now_us) const {
  return !screenshots_.empty() && (is_idle() || now_us - screenshot_since_us_ > kScreenshotWaitUs);
}

bool MeshPipeline::is_frame_due(TimeUs now_us) const {
  if (!draw_queue_ || frame_.in_progress) return false;
  // Off screen, frames serve edits and screenshots. More frames would only slow down loading.
  const bool is_changing =
      changed_ || !tracker_.empty() || (watched_ && inspection_.is_fading(now_us));
  const bool is_due = is_changing && now_us >= next_frame_us_;
  return is_due || tracker_.has_edits() || is_screenshot_due(now_us);
}

void MeshPipeline::draw(TimeUs now_us, FrameOrder order) {
  RUNSTONE_ASSERT(is_frame_due(now_us));
  const bool screenshot_due = is_screenshot_due(now_us);
  order.contents.look = look_.look(now_us);
  if (screenshot_due) {
    order.contents.look.exact = true;
    order.shows_all = true;
    order.screenshots = std::exchange(screenshots_, {});
  }
  if (inspection_.modes().any()) {
    const ChunkCoord eye = chunk_of_eye(order.camera, replica_.chunk_edge());
    order.contents.inspection =
        inspection_.inspection(replica_, eye, order.contents.look.exact, now_us);
  }
  draw_queue_->draw(std::move(order));
  frame_ = {true, screenshot_due};
  changed_ = false;
  if (watched_) next_frame_us_ = now_us + frame_interval_us_;
}

void MeshPipeline::request_screenshot(std::string path, TimeUs now_us) {
  screenshots_.push_back(std::move(path));
  screenshot_since_us_ = now_us;
}

bool MeshPipeline::has_caught_up() {
  if (!last_job_) last_job_ = planner_.jobs();
  return !tracker_.has_edits_up_to(*last_job_);
}

void MeshPipeline::add_to(ClientReport& report) const {
  report.renderer = renderer_name();
  report.latency = recorder_.report();
  report.join = join();
  report.far.tiles = replica_.far_tiles().count();
  report.far.bytes = far_bytes();
  report.meshes.whole_ns = whole_ns_;
  report.meshes.layers_ns = layers_ns_;
  report.meshes.kept_bytes = planner_.kept_bytes();
  report.meshes.jobs = planner_.jobs();
  report.meshes.chunks = planner_.chunks_meshed();
  report.frames = frames_;
}

}  // namespace runstone
