// Player: the position and direction of the eye, which flies through the world or walks in it, and
// the selected material.
#pragma once
#include <optional>
#include <utility>

#include "client/body/walker.hpp"
#include "client/input/window_input.hpp"
#include "client/render/renderer.hpp"
#include "client/replica/ray_pick.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// A walking player who has fallen this far, in voxels, without touching a voxel is moved to the
/// spawn. The reason of such a fall is a hole in the ground, or a world without ground.
inline constexpr double kFallMax = 600;
inline constexpr double kReach = 64;  // voxels from the eye to the voxel that a click changes

class Player {
 public:
  const WorldPos& eye() const { return eye_; }
  void move_to(const WorldPos& eye);
  bool is_walking() const { return is_walking_; }
  /// Makes the player walk, with a body that falls and that voxels stop, or fly.
  void set_walking(bool is_walking);
  /// Call it when a world opens. The player keeps the position if the world is the one of the last
  /// call. Otherwise the player moves to `place`, or to `spawn` if `place` is nullopt.
  void enter(const WorldId& world, const WorldPos& spawn,
             const std::optional<Pose>& place = std::nullopt);
  /// Sets the direction, in radians. The pitch is limited to just less than straight up and down.
  void look(double yaw, double pitch);
  LookDirection direction() const { return look_direction(yaw_, pitch_); }
  Pose pose() const;
  /// `view_voxels` is the distance to the far plane; the camera uses 64 at least.
  Camera camera(double view_voxels) const;
  /// Returns the voxel that the eye is in, or the nearest one inside the world. A coordinate that
  /// is not a number counts as 0.
  VoxelPos voxel() const;
  /// Returns the chunk of voxel(). `edge` is the edge of a chunk in voxels.
  ChunkCoord chunk(std::int32_t edge) const { return chunk_of(voxel(), edge); }

  /// Returns the material that a click places.
  Material held() const { return held_; }
  void hold(Material material) { held_ = material; }
  /// Returns true if the player's body is in this voxel. A player that flies has an eye only.
  bool is_in(VoxelPos voxel) const;
  /// Turns the player as the mouse moved.
  void turn(const WindowInput& input);
  /// Applies the keys of the last `seconds` to a player that flies, at the flying speed, or five
  /// times as fast with the key for it. Requires !is_walking().
  void fly(const WindowInput& input, double seconds);
  /// Applies the keys of the last `seconds` to a player that walks. Requires is_walking(). Cost:
  /// Walker::advance().
  void walk(const WindowInput& input, double seconds, const VoxelSpace& space,
            const BodyMaterials& materials);
  /// Returns true if the player walks and rests, because the ground there is not here yet.
  bool is_waiting_for_ground() const { return is_walking_ && walker_.is_waiting(); }
  /// Returns true once after a walking player fell for kFallMax voxels without meeting anything.
  /// The player is then at the spawn of the world, and flies.
  bool take_fallen_out() { return std::exchange(has_fallen_out_, false); }

  /// Returns the speed of flight in voxels a second.
  double flying_speed() const;
  /// Doubles the flying speed `steps` times, or halves it for negative steps, between 1.5 and 96.
  void change_flying_speed(int steps);

 private:
  std::optional<WorldId> world_;  // of the last enter()
  WorldPos spawn_;                // of that world
  WorldPos eye_;
  double yaw_ = 0, pitch_ = 0;
  int speed_step_ = 0;  // each one doubles the flying speed
  bool is_walking_ = false, has_fallen_out_ = false;
  Walker walker_;  // valid while the player walks
  Material held_ = 1;
};

/// Returns the yaw and the pitch of a pose in radians.
double yaw_of(const Pose& pose);
double pitch_of(const Pose& pose);

}  // namespace runstone
