// AssumedPosition: the place where the server takes a player to be. Clients claim places of their
// players. This place moves towards the claimed one with a bounded speed, so that a limit of the
// reach holds for a client that jumps from place to place.
// Thread: one. Times are arguments (microseconds of one steady clock).
#pragma once
#include <cmath>

#include "protocol/codec/messages.hpp"

namespace runstone {

class AssumedPosition {
 public:
  /// Begins at a place where the player is known to be.
  void start(const WorldPos& at, TimeUs now_us) {
    at_ = at;
    moved_us_ = now_us;
  }
  /// Moves on a straight line towards `claimed`, at most `speed` voxels for each second since the
  /// last call, and returns the new place. Speed 0: no limit.
  const WorldPos& advance(const WorldPos& claimed, double speed, TimeUs now_us) {
    const double way = std::hypot(claimed.x - at_.x, claimed.y - at_.y, claimed.z - at_.z);
    const double step = speed * static_cast<double>(now_us - moved_us_) / 1e6;
    moved_us_ = now_us;
    if (speed == 0 || way <= step) {
      at_ = claimed;
    } else {
      const double part = step / way;
      at_ = {at_.x + (claimed.x - at_.x) * part, at_.y + (claimed.y - at_.y) * part,
             at_.z + (claimed.z - at_.z) * part};
    }
    return at_;
  }

 private:
  WorldPos at_;
  TimeUs moved_us_ = 0;
};

}  // namespace runstone
