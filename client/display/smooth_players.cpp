#include "client/display/smooth_players.hpp"

#include <algorithm>
#include <utility>

namespace runstone {

void SmoothPlayers::update(const std::map<AuthorId, OtherPlayer>& others, TimeUs now_us) {
  const auto has_left = [&](const auto& entry) {
    const auto found = others.find(entry.first);
    return found == others.end() || !found->second.pose;
  };
  if (std::erase_if(tracks_, has_left) != 0) has_changed_ = true;
  for (const auto& [author, other] : others) {
    if (!other.pose) continue;
    const auto known = tracks_.find(author);
    if (known == tracks_.end()) {
      tracks_.emplace(author, PoseTrack(*other.pose, now_us));
    } else if (known->second.latest() != *other.pose) {
      known->second.add(*other.pose, now_us);
    } else {
      continue;
    }
    has_changed_ = true;
  }
}

std::map<AuthorId, Pose> SmoothPlayers::at(TimeUs now_us) const {
  std::map<AuthorId, Pose> out;
  for (const auto& [author, track] : tracks_) out.emplace_hint(out.end(), author, track.at(now_us));
  return out;
}

bool SmoothPlayers::take_moved(TimeUs now_us) {
  const bool is_moving = std::any_of(tracks_.begin(), tracks_.end(), [now_us](const auto& entry) {
    return entry.second.is_moving(now_us);
  });
  const bool was_moving = std::exchange(was_moving_, is_moving);
  const bool has_changed = std::exchange(has_changed_, false);
  return has_changed || is_moving || was_moving;
}

}  // namespace runstone
