// MeshPipeline: turns changes of the replica into frames. It schedules mesh jobs, uploads and
// frames, and records when each of them was done.
// Thread: the main thread only. The pool's threads mesh, and the draw thread uploads and draws.
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/display/draw_queue.hpp"
#include "client/display/inspection_control.hpp"
#include "client/display/look_control.hpp"
#include "client/display/upload_tracker.hpp"
#include "client/far/far_planner.hpp"
#include "client/report/report.hpp"
#include "client/schedule/byte_ledger.hpp"
#include "client/schedule/join_recorder.hpp"
#include "client/schedule/latency_recorder.hpp"
#include "client/schedule/mesh_planner.hpp"
#include "client/schedule/mesh_pool.hpp"
#include "client/session/client_session.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/mesh_materials.hpp"
#include "common/mesh_materials/mesh_materials_of.hpp"

namespace runstone {

class MeshPipeline {
 public:
  /// `replica` and `draw_queue` must outlive the pipeline. Requires that `draw_queue` shows
  /// nothing of another world (DrawQueue::clear()). It may be null; then the last stage of an edit
  /// is `meshed`. `watched` is true if frames go to a window. `wake` is called from mesh threads.
  MeshPipeline(const Replica& replica, DrawQueue* draw_queue, bool watched, unsigned workers,
               std::function<void()> wake);

  bool draws() const { return draw_queue_ != nullptr; }
  std::string renderer_name() const { return draw_queue_ ? draw_queue_->screen_name() : "none"; }

  /// Sets the world's materials, and `meshed`, which mesh_materials_of() makes of them. If a
  /// material lies before the first one that differs from the table before, its voxels look the
  /// same, and only chunks with other materials are meshed again. Otherwise all chunks are.
  void set_materials(const MaterialTable& materials, MeshMaterialsPtr meshed);
  void set_materials(const MaterialTable& materials) {
    set_materials(materials, mesh_materials_of(materials));
  }
  const MaterialTable& materials() const { return materials_; }
  /// Sets the textures of the world. A null pointer means that there are none.
  void set_textures(DrawnTexturesPtr textures) {
    if (draw_queue_ != nullptr) draw_queue_->set_textures(std::move(textures));
    changed_ = true;
  }
  /// Call it when the replica's view covers other chunks.
  void view_changed() { planner_.view_changed(); }
  void set_eye(ChunkCoord eye) {
    planner_.set_eye(eye);
    far_planner_.set_eye(eye);
  }
  /// Sets the memory that meshes may take, those on the GPU included. Beyond it one job is made at
  /// a time, so that the nearest chunk is meshed in any case.
  void set_mesh_bytes_max(std::size_t bytes) { mesh_bytes_max_ = bytes; }
  /// Returns the number of chunks that were meshed so far.
  std::uint64_t meshed_count() const { return planner_.chunks_meshed(); }
  /// Returns the memory of the newest meshes of all chunks, and of kept borders.
  std::size_t mesh_bytes() const { return planner_.kept_bytes(); }
  /// Returns the memory of the chunks that were queued for upload and not removed since.
  std::size_t gpu_bytes() const { return gpu_bytes_.total(); }
  /// Returns the memory of tiles, stand-ins, and the meshes of both that were queued for upload and
  /// not removed since.
  std::size_t far_bytes() const {
    return replica_.far_tiles().bytes() + far_planner_.bytes() + far_gpu_bytes_.total();
  }
  /// Returns true if all tiles that arrived are meshed.
  bool is_far_meshed() const {
    return far_planner_.dirty_count() == 0 && (!pool_ || pool_->tiles_in_flight() == 0);
  }
  /// Returns the control of the look of all frames.
  LookControl& look() { return look_; }
  const LookControl& look() const { return look_; }
  /// Returns the modes in which frames show how chunks are stored and meshed.
  const InspectionControl& inspection() const { return inspection_; }
  void inspect(const InspectionModes& modes) {
    inspection_.set(modes);
    changed_ = true;
  }
  /// With true, frames off screen follow one another without a pause, for measurements.
  void set_unpaced(bool unpaced) { is_unpaced_ = unpaced; }
  /// Returns the time that drawing the last presented frame took.
  TimeUs last_frame_us() const { return last_frame_us_; }
  /// With false, the automatic quality does not follow the time that drawing took. That is for
  /// screens that do not wait for the GPU, whose owner calls look().frame_took().
  void set_measures_frames(bool measures) { measures_frames_ = measures; }
  /// Sets the least time between two frames of a window that show no new edit.
  void set_frame_interval(TimeUs interval_us) { frame_interval_us_ = interval_us; }
  /// Call it when the camera or a marker moved.
  void moved() { changed_ = true; }

  void take(const ReplicaChanges& changes, const ClockOffset& clock, TimeUs now_us);
  /// Records the uploads and frames that the draw thread completed. Throws std::runtime_error if it
  /// failed.
  void take_drawn();
  /// Queues the completed meshes for upload, meshes small changes itself and gives the workers new
  /// jobs.
  void mesh();
  /// Returns true if no frame is in progress and one is due.
  bool is_frame_due(TimeUs now_us) const;
  /// Orders a frame, with the screenshots that are due, and sets its look. Requires
  /// is_frame_due().
  void draw(TimeUs now_us, FrameOrder order);

  /// Writes a PNG of the next frame that is drawn while no mesh is unfinished, or of the first
  /// frame after kScreenshotWaitUs. Requires draws().
  void request_screenshot(std::string path, TimeUs now_us);
  bool screenshots_done() const { return screenshots_.empty() && !frame_.screenshots; }
  /// Fails if one of the newest completed screenshots could not be written. The error begins with
  /// the name of the file.
  const Result<void, std::string>& screenshots_written() const { return screenshots_written_; }
  /// Returns the errors of the screenshots that could not be written since the last call. Each begins
  /// with the name of the file.
  std::vector<std::string> take_unwritten() { return std::exchange(unwritten_, {}); }

  /// Returns true if all shown runs are meshed and a frame with all of these meshes was presented.
  bool is_up_to_date() const {
    return planner_.dirty_count() == 0 && far_planner_.dirty_count() == 0 && is_idle() &&
           tracker_.empty();
  }
  /// Returns true if every edit that was meshed before the first call has been presented. That
  /// takes a bounded number of frames, whatever other players edit meanwhile
  /// (UploadQueue::kPatience). Call it when the program wants to end.
  bool has_caught_up();
  /// Returns the last kRecentFramesMax frames that were presented; the newest one is the last.
  const std::deque<FrameDone>& recent_frames() const { return recent_frames_; }
  static constexpr std::size_t kRecentFramesMax = 120;
  const FrameStats& frames() const { return frames_; }
  const Histogram& whole_mesh_ns() const { return whole_ns_; }
  const Histogram& layers_mesh_ns() const { return layers_ns_; }
  std::uint64_t mesh_jobs() const { return planner_.jobs(); }
  std::uint64_t far_jobs() const { return far_planner_.jobs(); }
  std::uint64_t frames_presented() const { return frames_.presented; }
  LatencyRecorder& recorder() { return recorder_; }
  const LatencyRecorder& recorder() const { return recorder_; }
  /// Records the world's first view, of a client that began to connect at `began_us`.
  void joined(const View& view, TimeUs began_us) { join_.begin(view, began_us); }
  const JoinReport& join() const { return join_.report(); }
  /// Sets the counts of meshes and frames.
  void add_to(ClientReport& report) const;

  /// The default of set_frame_interval(). The swap decides the exact time of a frame.
  static constexpr TimeUs kFrameUs = 16'000;
  /// The time per turn that mesh() spends on meshes of changed layers. The workers make the other
  /// meshes.
  static constexpr TimeUs kMeshHereUs = 1'000;
  /// The least time off screen between a frame and the next one that shows no new edit.
  static constexpr TimeUs kFrameOffScreenUs = 100'000;
  static constexpr TimeUs kScreenshotWaitUs = 10'000'000;

 private:
  bool is_screenshot_due(TimeUs now_us) const;
  bool is_idle() const {
    return planner_.ready_count() == 0 && far_planner_.ready_count() == 0 &&
           (!pool_ || (pool_->in_flight() == 0 && pool_->tiles_in_flight() == 0));
  }
  void take_results();
  void take_result(MeshResult result);
  /// Meshes the layers that edits changed, on this thread: passing such a job to a worker and back
  /// takes longer than the job.
  void mesh_layers();
  void push_jobs();
  void push_tiles();
  void take_tile(FarMeshResult result);
  bool has_room_for_jobs() const;
  void take_frame(const FrameDone& frame);

  const bool watched_;
  const unsigned workers_;
  const std::function<void()> wake_;
  LatencyRecorder recorder_;
  JoinRecorder join_;
  const Replica& replica_;
  MeshPlanner planner_;
  FarPlanner far_planner_;
  std::size_t mesh_bytes_max_ = std::numeric_limits<std::size_t>::max();
  ByteLedger<std::uint64_t> open_job_bytes_;  // expected, by job number
  ByteLedger<ChunkKey> gpu_bytes_, far_gpu_bytes_;
  MaterialTable materials_;
  MeshMaterialsPtr meshed_ = std::make_shared<const MeshMaterials>();  // of materials_
  Histogram whole_ns_, layers_ns_;
  FrameStats frames_;
  std::deque<FrameDone> recent_frames_;
  LookControl look_;
  InspectionControl inspection_;
  bool is_unpaced_ = false, measures_frames_ = true;
  TimeUs last_frame_us_ = 0;
  // True if the camera, a marker or the look has changed since the last frame was ordered.
  bool changed_ = true;
  struct {
    bool in_progress = false, screenshots = false;
  } frame_;                                // the frame in progress
  UploadTracker tracker_;                  // of the meshes that draw_queue_ got
  std::optional<std::uint64_t> last_job_;  // has_caught_up(): the newest mesh job to wait for
  TimeUs frame_interval_us_ = kFrameUs;
  TimeUs next_frame_us_ = 0;              // the earliest time of a frame without new edits
  std::vector<std::string> screenshots_;  // files requested
  TimeUs screenshot_since_us_ = 0;
  Result<void, std::string> screenshots_written_;  // of the newest completed ones
  std::vector<std::string> unwritten_;             // of take_unwritten()
  DrawQueue* const draw_queue_;                    // may be null
  // Null until the materials are set. It is the last member, because its threads use the others.
  std::unique_ptr<MeshPool> pool_;
};

}  // namespace runstone
