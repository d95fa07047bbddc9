// Player: the eye that flies through the world, and what it holds.
#pragma once
#include <cstddef>
#include <optional>

#include "client/platform/window.hpp"
#include "client/render/renderer.hpp"
#include "client/replica/ray_pick.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

inline constexpr double kReach = 64;  // voxels from the eye to what is dug or placed against

class Player {
 public:
  const WorldPos& eye() const { return eye_; }
  void move_to(const WorldPos& eye) { eye_ = eye; }
  /// A world is open. In the one that the player was in before they stay where they are; in any other one
  /// that place means nothing, and they begin at its spawn.
  void enter(const WorldId& world, const WorldPos& spawn);
  /// Radians; pitch is kept short of straight up and down.
  void look(double yaw, double pitch);
  LookDirection direction() const { return look_direction(yaw_, pitch_); }
  Pose pose() const;
  Camera camera(double view_voxels) const;
  ChunkCoord chunk(std::int32_t edge) const;

  Material held() const { return held_; }
  /// Keys, mouse and wheel of one frame; `material_count` bounds what can be held.
  void steer(const WindowInput& input, double seconds, std::size_t material_count);

 private:
  std::optional<WorldId> world_;  // none before the first
  WorldPos eye_;
  double yaw_ = 0, pitch_ = 0;
  Material held_ = 1;
};

/// Yaw in radians of a pose, for drawing others.
double yaw_of(const Pose& pose);

}  // namespace runstone
