// GroundRules: sends each session what its player may do (Permissions) and the protected boxes
// near its view (ProtectedGround), so that its client predicts only edits that are allowed. A
// session knows at most kGroundBoxesMax boxes: those that overlap the cuboid of chunks around its
// view. If there are more, the cuboid is halved around the centre until they fit.
//
// A change only marks the sessions that it affects. On the next tick, each of them gets the
// difference to what it was sent. After kGroundBoxesPerTick compared boxes the other sessions wait
// for the next tick. A session whose queue is full is tried again on every tick. A session that
// looks at the past waits until it is back.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <vector>

#include "server/world/ground/ground_base.hpp"

namespace runstone {

/// Boxes that are compared on one tick. The last session may exceed it.
inline constexpr std::size_t kGroundBoxesPerTick = 16'384;

class GroundRules {
 public:
  explicit GroundRules(GroundBase& base) : base_(base) {}

  /// Sends a session that has just opened its permissions.
  void start(Viewer& viewer);
  /// Rights have changed, on this ground and for players in general. Cost: O(sessions * (log n +
  /// ground)).
  void rights_changed(const std::vector<VoxelBox>& ground);
  /// Sends what is due. Call it on every tick.
  void send_due();

 private:
  Permissions permissions_of(const PublicKey& key) const;
  TimeUs restricted_until(const PublicKey& key) const;
  void refresh_permissions(Viewer& viewer);
  void send_permissions(Viewer& viewer);
  std::size_t send_boxes(Viewer& viewer);

  GroundBase& base_;
  SessionId sent_last_ = 0;  // the session whose boxes were sent last on a tick
};

}  // namespace runstone
