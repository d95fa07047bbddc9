// DisplayPace: makes a window draw often while something moves, and seldom otherwise. A window
// without focus draws at most every kBackgroundFrameUs, so that the window in use has the
// processor. Thread: the main thread.
#pragma once
#include "client/display/mesh_pipeline.hpp"
#include "common/core/ids.hpp"

namespace runstone {

class DisplayPace {
 public:
  /// Sets the pace of the frames. `has_focus`: the window has the keyboard. `pose` is that of the
  /// player. `is_moving`: another player has moved, or the interface fades something.
  void step(MeshPipeline& pipeline, bool has_focus, const Pose& pose, bool is_moving,
            TimeUs now_us);
  /// Call it when a frame was ordered.
  void drew(TimeUs now_us) { drawn_us_ = now_us; }

  /// The time between two frames in which nothing has moved.
  static constexpr TimeUs kStillFrameUs = 1'000'000;
  /// The time between two frames while only waves or the ghosts of a preview move. They move slowly,
  /// so that few frames suffice.
  static constexpr TimeUs kAnimatedFrameUs = 200'000;
  /// The least time between two frames of a window without focus.
  static constexpr TimeUs kBackgroundFrameUs = 100'000;

 private:
  Pose pose_;            // of the player in the last step
  TimeUs drawn_us_ = 0;  // when the last frame was ordered
};

}  // namespace runstone
