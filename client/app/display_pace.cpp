#include "client/app/display_pace.hpp"

#include <utility>

namespace runstone {

void DisplayPace::step(MeshPipeline& pipeline, const ClientSession& session, bool has_focus,
                       const Pose& pose, bool is_hud_moving, TimeUs now_us) {
  pipeline.set_frame_interval(has_focus ? MeshPipeline::kFrameUs : kBackgroundFrameUs);
  const auto& frames = pipeline.recent_frames();
  const bool is_animated = !frames.empty() && frames.back().stats.is_animated;
  const TimeUs idle_us = has_focus && is_animated ? kAnimatedFrameUs : kStillFrameUs;
  if (is_moving(session, pose, is_hud_moving, now_us) || now_us - drawn_us_ >= idle_us)
    pipeline.moved();
}

bool DisplayPace::is_moving(const ClientSession& session, const Pose& pose, bool is_hud_moving,
                            TimeUs now_us) {
  const bool has_moved = std::exchange(pose_, pose) != pose;
  const auto& others = session.others();
  bool have_moved = others_.size() != others.size();
  others_.resize(others.size());
  std::size_t i = 0;
  for (const auto& [author, other] : others) {
    std::optional<Pose>& known = others_[i++];
    have_moved = have_moved || known != other.pose;
    known = other.pose;
  }
  if (have_moved) posed_us_ = now_us;
  return has_moved || now_us - posed_us_ < kPoseUs || is_hud_moving;
}

}  // namespace runstone
