// Picture: the way from what changed to what is seen: mesh jobs, uploads, frames, and when each of them was
// done. Main thread only; the meshing itself is on the pool's threads and the drawing on the draw thread.
// Here is decided what they do and when.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/display/draw_thread.hpp"
#include "client/replica/client_session.hpp"
#include "client/report/report.hpp"
#include "client/schedule/join_recorder.hpp"
#include "client/schedule/latency_recorder.hpp"
#include "client/schedule/mesh_planner.hpp"
#include "client/schedule/mesh_pool.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

class MeshPipeline {
 public:
  /// `draw_thread` may be null: then edits end at `meshed`. `watched`: frames go to somebody's eyes, not only
  /// into files. `replica` must outlive the picture. `wake` is called from mesh threads.
  MeshPipeline(const Replica& replica, std::unique_ptr<DrawThread> draw_thread, bool watched,
               unsigned workers, std::function<void()> wake);

  bool draws() const { return draw_thread_ != nullptr; }
  std::string renderer_name() const { return draw_thread_ ? draw_thread_->screen_name() : "none"; }

  /// The world's materials are known, or are other ones now.
  void set_materials(const MaterialTable& materials);
  const MaterialTable& materials() const { return materials_; }
  /// The replica's view moved.
  void view_changed() { planner_.view_changed(); }
  void set_eye(ChunkCoord eye) { planner_.set_eye(eye); }
  /// The camera, or something else that is drawn, moved.
  void moved() { changed_ = true; }

  void take(const ReplicaChanges& news, const ClockOffset& clock, TimeUs now_us);
  /// Learns what the draw thread did. Throws std::runtime_error if it failed.
  void take_drawn();
  /// Hands over the meshes that are done and gives the workers what is next.
  void mesh();
  /// Orders a frame of width x height pixels if there is reason to, the time has come and none is under way.
  /// `markers` is asked only then.
  void draw(TimeUs now_us, const Camera& camera, std::array<int, 2> size,
            const std::function<std::vector<Marker>()>& markers);

  /// The next frame in which no mesh is missing, or one after kScreenshotWaitUs, becomes this PNG. Requires
  /// draws().
  void request_screenshot(std::string path, TimeUs now_us);
  bool screenshots_done() const { return screenshots_.empty() && !frame_.screenshots; }
  /// Whether the newest screenshots that are done could be written.
  bool screenshots_written() const { return screenshots_written_; }

  /// Everything that the replica shows is meshed, and a frame that shows all of these meshes was presented.
  bool is_settled() const {
    return planner_.dirty_count() == 0 && is_idle() && !uploads_waiting_ && !frame_.uploads;
  }
  /// Whether all that was handed over before the first such question is on the screen: two frames later at
  /// the most, whatever others edit meanwhile. Asked when the program wants to end.
  bool has_caught_up();
  std::uint64_t frames_presented() const { return frames_.presented; }
  LatencyRecorder& recorder() { return recorder_; }
  const LatencyRecorder& recorder() const { return recorder_; }
  /// The world's first view, by a client that began to connect then.
  void joined(const View& view, TimeUs began_us) { join_.begin(view, began_us); }
  const JoinReport& join() const { return join_.report(); }
  /// Adds what was meshed and drawn.
  void report(ChunkStats& chunks, FrameStats& frames) const;

  static constexpr TimeUs kFrameUs =
      16'000;  // in a window, from order to order; the swap paces more finely
  static constexpr TimeUs kMeshHereUs = 1'000;  // of a turn; what is more goes to the workers
  static constexpr TimeUs kFrameOffScreenUs =
      100'000;  // off screen, after a frame until one without new edits
  static constexpr TimeUs kScreenshotWaitUs = 10'000'000;

 private:
  bool is_idle() const {
    return planner_.ready_count() == 0 && (!pool_ || pool_->in_flight() == 0);
  }
  void take_results();
  void take_result(MeshResult result);
  /// What edits changed is made here and now: to hand it to a worker and to take it back takes longer.
  void mesh_layers();
  void push_jobs();
  void take_frame(const FrameDone& frame);

  const bool watched_;
  const unsigned workers_;
  const std::function<void()> wake_;
  LatencyRecorder recorder_;
  JoinRecorder join_;
  MeshPlanner planner_;
  MaterialTable materials_;
  Histogram whole_ns_, layers_ns_;
  FrameStats frames_;
  // Since the last frame was ordered:
  bool changed_ = true;           // something that is drawn
  bool uploads_waiting_ = false;  // a mesh was handed over
  bool edits_waiting_ = false;    // a mesh with edits was
  struct {
    bool under_way = false, uploads = false, screenshots = false;
  } frame_;  // the one that was ordered last, and whether it shows new meshes
  std::uint64_t frames_ordered_ = 0;
  std::optional<std::uint64_t> last_frame_;  // has_caught_up(): the frame to wait for
  TimeUs next_frame_us_ = 0;                 // not before, if there is no new edit
  std::vector<std::string> screenshots_;     // to take
  TimeUs screenshot_since_us_ = 0;
  bool screenshots_written_ = true;
  std::unique_ptr<DrawThread> draw_thread_;  // may be null
  std::unique_ptr<MeshPool> pool_;  // once the materials are known; its threads use what is above
};

}  // namespace runstone
