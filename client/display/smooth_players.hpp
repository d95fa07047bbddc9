// SmoothPlayers: where the other players are shown in each frame. Bodies, name plates and the map
// use the same poses. Pure: times are arguments, in microseconds of the client's steady clock. One
// thread.
#pragma once
#include <map>

#include "client/display/pose_track.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

class SmoothPlayers {
 public:
  /// Takes the poses that arrived, and forgets players who left. Call it every turn. Cost:
  /// O(players).
  void update(const std::map<AuthorId, OtherPlayer>& others, TimeUs now_us);
  /// Returns the poses of those whose pose is known, by author.
  std::map<AuthorId, Pose> at(TimeUs now_us) const;
  /// Returns true if the next frame shows other poses than the frame at the call before, because a
  /// player moves, came or left. Players who stand still cost no frames.
  bool take_moved(TimeUs now_us);

 private:
  std::map<AuthorId, PoseTrack> tracks_;
  bool has_changed_ = false;  // somebody came, left, or sent a pose since the last take_moved()
  bool was_moving_ = false;  // at the last take_moved(): the place where it ends is shown once more
};

}  // namespace runstone
