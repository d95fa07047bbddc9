// DisplayPace: lets a window draw often while something moves, and seldom otherwise. A window without
// focus leaves the processor to the window in use. Thread: the main thread.
#pragma once
#include <optional>
#include <vector>

#include "client/display/mesh_pipeline.hpp"
#include "client/session/client_session.hpp"
#include "common/core/ids.hpp"

namespace runstone {

class DisplayPace {
 public:
  /// Sets the pace of the frames. `has_focus`: the window has the keyboard. `pose` is that of the
  /// player. `is_hud_moving`: the interface fades something.
  void step(MeshPipeline& pipeline, const ClientSession& session, bool has_focus, const Pose& pose,
            bool is_hud_moving, TimeUs now_us);
  /// Call it when a frame was ordered.
  void drew(TimeUs now_us) { drawn_us_ = now_us; }

  /// The time between two frames in which nothing has moved.
  static constexpr TimeUs kStillFrameUs = 1'000'000;
  /// The same while waves or the ghost of a preview are in sight. They go on slowly.
  static constexpr TimeUs kAnimatedFrameUs = 200'000;
  /// The least time between two frames of a window without focus.
  static constexpr TimeUs kBackgroundFrameUs = 100'000;
  /// Other players count as moving for this time after a new pose.
  static constexpr TimeUs kPoseUs = 300'000;

 private:
  /// Returns true if the next frame differs from the last one.
  bool is_moving(const ClientSession& session, const Pose& pose, bool is_hud_moving, TimeUs now_us);

  Pose pose_;                                // of the player in the last step
  std::vector<std::optional<Pose>> others_;  // the poses of the others then
  TimeUs posed_us_ = 0;                      // when one of these last changed
  TimeUs drawn_us_ = 0;                      // when the last frame was ordered
};

}  // namespace runstone
