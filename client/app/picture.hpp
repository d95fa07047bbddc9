// Picture: the way from what changed to what is seen: mesh jobs, uploads, frames, and when each of them was
// done. Main thread only; the meshing itself is on the pool's threads.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "client/app/report.hpp"
#include "client/app/screen.hpp"
#include "client/replica/client_session.hpp"
#include "client/schedule/latency_recorder.hpp"
#include "client/schedule/mesh_planner.hpp"
#include "client/schedule/mesh_pool.hpp"

namespace runstone {

class Picture {
 public:
  /// `screen` may be null: then edits end at `meshed`. `replica` must outlive the picture. `wake` is called
  /// from mesh threads.
  Picture(const Replica& replica, std::unique_ptr<Screen> screen, unsigned workers,
          std::function<void()> wake);

  Screen* screen() { return screen_.get(); }
  const char* renderer_name() const { return screen_ ? screen_->name() : "none"; }

  /// The world's materials are known, or are other ones now.
  void set_materials(const MaterialTable& materials);
  const MaterialTable& materials() const { return materials_; }
  /// The replica's view moved.
  void view_changed() { planner_.view_changed(); }
  void set_eye(ChunkCoord eye) { planner_.set_eye(eye); }
  /// The camera, or something else that is drawn, moved.
  void moved() { changed_ = true; }

  void take(const ReplicaNews& news, const ClockOffset& clock, TimeUs now_us);
  /// Uploads the meshes that are done and gives the workers what is next.
  void mesh();
  /// Draws if there is reason to and the time has come. `markers` is asked only then. Returns whether it
  /// drew.
  bool draw(TimeUs now_us, const Camera& camera, const std::function<std::vector<Marker>()>& markers);

  /// The next frame in which no mesh is missing, or one after kScreenshotWaitUs, becomes this PNG. Requires a
  /// screen.
  void request_screenshot(std::string path, TimeUs now_us);
  bool screenshots_done() const { return screenshots_.empty(); }

  /// Everything that can be meshed is meshed, and edits are on the screen.
  bool is_settled() const { return planner_.dirty_count() == 0 && is_idle() && !edits_uploaded_; }
  LatencyRecorder& recorder() { return recorder_; }
  const LatencyRecorder& recorder() const { return recorder_; }
  /// Adds what was meshed.
  void report(ChunkStats& stats) const;

  static constexpr TimeUs kFrameUs = 16'000;            // between two frames in a window
  static constexpr TimeUs kFrameOffScreenUs = 100'000;  // off screen, between frames that show no new edit
  static constexpr TimeUs kScreenshotWaitUs = 10'000'000;

 private:
  bool is_idle() const { return planner_.ready_count() == 0 && (!pool_ || pool_->in_flight() == 0); }
  void take_results();
  void push_jobs();
  void take_screenshots();

  std::unique_ptr<Screen> screen_;
  const unsigned workers_;
  const std::function<void()> wake_;
  LatencyRecorder recorder_;
  MeshPlanner planner_;
  MaterialTable materials_;
  Histogram mesh_ns_;
  bool changed_ = true;          // since the last frame
  bool edits_uploaded_ = false;  // a mesh with edits is on the GPU and not on the screen
  TimeUs drawn_us_ = 0;
  std::vector<std::string> screenshots_;  // to take
  TimeUs screenshot_since_us_ = 0;
  std::unique_ptr<MeshPool> pool_;  // once the materials are known; its threads use what is above
};

}  // namespace runstone
