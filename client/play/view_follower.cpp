#include "client/play/view_follower.hpp"

#include "client/far/far_reach.hpp"

namespace runstone {

bool ViewFollower::follow(TimeUs now_us) {
  session_.set_pose(player_.pose());
  if (!session_.replica().opened()) return false;
  View view = session_.view();
  view.centre = player_.chunk(session_.replica().chunk_edge());
  view.yaw = player_.pose().yaw;
  view.pitch = player_.pose().pitch;
  view.cone = kSightCone;
  if (!pace_.step(session_.view(), view, now_us)) return false;
  const bool moves = !session_.view().same_chunks(view);
  set_view(view);
  return moves;
}

void ViewFollower::set_radii(ViewRadii radii) {
  radii_ = radii;
  set_view(session_.view());
}

void ViewFollower::set_far_levels(std::uint8_t levels) {
  far_levels_ = levels;
  set_view(session_.view());
}

void ViewFollower::set_view(View view) {
  view.radius_h = radii_.h;
  view.radius_v = radii_.v;
  view.levels = useful_levels(radii_.h, session_.replica().chunk_edge(), far_levels_);
  session_.set_view(view);
}

bool ViewFollower::has_followed() const {
  return session_.replica().opened() &&
         session_.view().centre == player_.chunk(session_.replica().chunk_edge());
}

void ViewFollower::update_completeness(TimeUs now_us) {
  if (!is_complete()) {
    complete_since_us_.reset();
  } else if (!complete_since_us_) {
    complete_since_us_ = now_us;
  }
}

}  // namespace runstone
