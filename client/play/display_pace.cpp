#include "client/play/display_pace.hpp"

#include <utility>

namespace runstone {

void DisplayPace::step(MeshPipeline& pipeline, bool has_focus, const Pose& pose, bool is_moving,
                       TimeUs now_us) {
  pipeline.set_frame_interval(has_focus ? MeshPipeline::kFrameUs : kBackgroundFrameUs);
  const auto& frames = pipeline.recent_frames();
  const bool is_animated = !frames.empty() && frames.back().stats.is_animated;
  const TimeUs idle_us = has_focus && is_animated ? kAnimatedFrameUs : kStillFrameUs;
  const bool has_moved = std::exchange(pose_, pose) != pose;
  if (has_moved || is_moving || now_us - drawn_us_ >= idle_us) pipeline.moved();
}

}  // namespace runstone
