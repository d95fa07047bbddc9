// MeshPipeline: turns changes of the replica into frames. It schedules mesh jobs, uploads and
// frames, and records when each of them was done.
// Thread: the main thread only. The pool's threads mesh, and the draw thread uploads and draws.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/display/draw_thread.hpp"
#include "client/report/report.hpp"
#include "client/schedule/byte_ledger.hpp"
#include "client/schedule/join_recorder.hpp"
#include "client/schedule/latency_recorder.hpp"
#include "client/schedule/mesh_planner.hpp"
#include "client/schedule/mesh_pool.hpp"
#include "client/session/client_session.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

class MeshPipeline {
 public:
  /// `replica` must outlive the pipeline. `draw_thread` may be null; then the last stage of an edit
  /// is `meshed`. `watched` is true if frames go to a window. `wake` is called from mesh threads.
  MeshPipeline(const Replica& replica, std::unique_ptr<DrawThread> draw_thread, bool watched,
               unsigned workers, std::function<void()> wake);

  bool draws() const { return draw_thread_ != nullptr; }
  std::string renderer_name() const { return draw_thread_ ? draw_thread_->screen_name() : "none"; }

  /// Sets the world's materials. If they only have more rows than before, the chunks that have one
  /// of these already are meshed again. If they differ otherwise, all chunks are.
  void set_materials(const MaterialTable& materials);
  const MaterialTable& materials() const { return materials_; }
  /// Call it when the replica's view covers other chunks.
  void view_changed() { planner_.view_changed(); }
  void set_eye(ChunkCoord eye) { planner_.set_eye(eye); }
  /// Sets the memory that meshes may take, those on the GPU included. Beyond it one job is made at
  /// a time, so that the nearest chunk is meshed all the same.
  void set_mesh_bytes_max(std::size_t bytes) { mesh_bytes_max_ = bytes; }
  /// Returns the memory of the newest meshes of all chunks.
  std::size_t mesh_bytes() const { return planner_.kept_bytes(); }
  /// Returns the memory of the quads that were queued for upload and not removed since.
  std::size_t gpu_bytes() const { return gpu_bytes_.total(); }
  /// Call it when the camera or a marker moved.
  void moved() { changed_ = true; }

  void take(const ReplicaChanges& changes, const ClockOffset& clock, TimeUs now_us);
  /// Records the uploads and frames that the draw thread completed. Throws std::runtime_error if it
  /// failed.
  void take_drawn();
  /// Queues the completed meshes for upload, meshes small changes itself and gives the workers new
  /// jobs.
  void mesh();
  /// Orders a frame of `size` (width, height in pixels) if no frame is in progress and one is due.
  /// Calls `markers` only in that case.
  void draw(TimeUs now_us, const Camera& camera, std::array<int, 2> size,
            const std::function<std::vector<Marker>()>& markers);

  /// Writes a PNG of the next frame that is drawn while no mesh is unfinished, or of the first
  /// frame after kScreenshotWaitUs. Requires draws().
  void request_screenshot(std::string path, TimeUs now_us);
  bool screenshots_done() const { return screenshots_.empty() && !frame_.screenshots; }
  /// Returns true if the newest completed screenshots could be written.
  bool screenshots_written() const { return screenshots_written_; }

  /// Returns true if all shown runs are meshed and a frame with all of these meshes was presented.
  bool is_up_to_date() const {
    return planner_.dirty_count() == 0 && is_idle() && !uploads_waiting_ && !frame_.uploads;
  }
  /// Returns true if every edit that was meshed before the first call has been presented. That
  /// takes at most two frames, whatever other players edit meanwhile. Call it when the program
  /// wants to end.
  bool has_caught_up();
  std::uint64_t frames_presented() const { return frames_.presented; }
  LatencyRecorder& recorder() { return recorder_; }
  const LatencyRecorder& recorder() const { return recorder_; }
  /// Records the world's first view, of a client that began to connect at `began_us`.
  void joined(const View& view, TimeUs began_us) { join_.begin(view, began_us); }
  const JoinReport& join() const { return join_.report(); }
  /// Sets the counts of meshes and frames.
  void add_to(ClientReport& report) const;

  /// The least time between two frame orders in a window. The swap decides the exact time of a
  /// frame.
  static constexpr TimeUs kFrameUs = 16'000;
  /// The time per turn that mesh() spends on meshes of changed layers. The workers make the other
  /// meshes.
  static constexpr TimeUs kMeshHereUs = 1'000;
  /// The least time off screen between a frame and the next one that shows no new edit.
  static constexpr TimeUs kFrameOffScreenUs = 100'000;
  static constexpr TimeUs kScreenshotWaitUs = 10'000'000;

 private:
  bool is_idle() const {
    return planner_.ready_count() == 0 && (!pool_ || pool_->in_flight() == 0);
  }
  void take_results();
  void take_result(MeshResult result);
  /// Meshes the layers that edits changed, on this thread: passing such a job to a worker and back
  /// takes longer than the job.
  void mesh_layers();
  void push_jobs();
  bool has_room_for_jobs() const;
  void take_frame(const FrameDone& frame);

  const bool watched_;
  const unsigned workers_;
  const std::function<void()> wake_;
  LatencyRecorder recorder_;
  JoinRecorder join_;
  MeshPlanner planner_;
  std::size_t mesh_bytes_max_ = std::numeric_limits<std::size_t>::max();
  ByteLedger<std::uint64_t> open_job_bytes_;  // expected, by job number
  ByteLedger<ChunkKey> gpu_bytes_;
  MaterialTable materials_;
  Histogram whole_ns_, layers_ns_;
  FrameStats frames_;
  // These flags are set by events since the last frame was ordered.
  bool changed_ = true;           // the camera, a marker or a mesh changed
  bool uploads_waiting_ = false;  // a mesh was queued for upload
  bool edits_waiting_ = false;    // a mesh was queued while an edit was not presented yet
  struct {
    bool in_progress = false, uploads = false, screenshots = false;
  } frame_;  // the frame in progress; true if it shows new meshes, and if it becomes screenshots
  std::uint64_t frames_ordered_ = 0;
  std::optional<std::uint64_t> last_frame_;  // has_caught_up(): the frame to wait for
  TimeUs next_frame_us_ = 0;                 // the earliest time of a frame without new edits
  std::vector<std::string> screenshots_;     // files requested
  TimeUs screenshot_since_us_ = 0;
  bool screenshots_written_ = true;
  std::unique_ptr<DrawThread> draw_thread_;  // may be null
  // Null until the materials are set. It is the last member, because its threads use the others.
  std::unique_ptr<MeshPool> pool_;
};

}  // namespace runstone
