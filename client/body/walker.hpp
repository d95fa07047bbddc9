// Walker: the body of a player that walks, jumps, steps up and down, wades and swims among voxels.
// Time passes in steps of kWalkStepS, so that the same input gives the same path at every frame
// rate. Pure: voxels, input and time are arguments. One thread.
#pragma once
#include "client/body/body_materials.hpp"
#include "common/collision/sweep.hpp"
#include "common/collision/voxel_space.hpp"
#include "common/core/world_pos.hpp"

namespace runstone {

// The body, in voxels. Its position is the middle of its bottom face.
inline constexpr double kBodyWidth = 0.6, kBodyHeight = 1.8, kEyeHeight = 1.62;
inline constexpr double kWalkStepS = 1.0 / 120;  // seconds
/// A body on the ground walks onto voxels that are at most this much higher, and without falling
/// down to those that are at most this much lower.
inline constexpr double kStepUpMax = 1.0;
/// A body swims if liquid reaches this height above its feet. In lower liquid it wades: slowly, but
/// on the ground, and it jumps as usual.
inline constexpr double kSwimDepth = 1.1;

/// The input of the player.
struct WalkInput {
  double x = 0, z = 0;  // direction over the ground, of length 1 at most; 1 is full speed
  bool up = false;      // jump, or rise in a liquid, and climb out of it
  bool down = false;    // sink in a liquid; on the ground: do not step over an edge
  bool fast = false;
};

BodyBox body_at(const WorldPos& feet);

class Walker {
 public:
  const WorldPos& feet() const { return feet_; }
  /// Returns the eye. After a step up or down it follows the body in some tenths of a second.
  WorldPos eye() const { return {feet_.x, feet_.y + kEyeHeight - step_lag_, feet_.z}; }
  /// Puts the body where its eye is at `eye`, at rest.
  void place_eye(const WorldPos& eye) { place({eye.x, eye.y - kEyeHeight, eye.z}); }
  bool is_on_ground() const { return is_on_ground_; }
  bool is_in_liquid() const { return is_in_liquid_; }
  /// Returns true if the last step found the body where the voxels are not known, so that it
  /// rested.
  bool is_waiting() const { return is_waiting_; }
  /// Returns by how many voxels the body has fallen since it last stood or touched a liquid.
  double fallen() const { return fallen_; }
  /// Puts the body somewhere, at rest.
  void place(WorldPos feet);
  /// Lets `seconds` pass. More than a quarter of a second counts as a quarter. A body rests where
  /// the voxels are not known. A body inside a solid voxel rises until it is free, and at once if
  /// it is deep inside, for example at a spawn in a hill.
  /// Cost: some sweeps for each step of kWalkStepS.
  void advance(const VoxelSpace& space, const BodyMaterials& materials, const WalkInput& input,
               double seconds);

 private:
  void step(const VoxelSpace& space, const BodyMaterials& materials, const WalkInput& input);
  /// Moves a body that is inside a solid voxel up.
  void rise_out(const VoxelSpace& space, const Obstacles& solid);
  /// Changes the speed as input, ground and liquid want it.
  void accelerate(const WalkInput& input, bool swims);
  /// Moves the body by `by`, and up a step if `may_step_up` and the step is low enough.
  void move(const VoxelSpace& space, const Obstacles& solid, const WorldPos& by, bool may_step_up);
  /// Puts a body that has just walked over an edge onto ground that is low enough for a step down.
  void step_down(const VoxelSpace& space, const Obstacles& solid);
  /// Returns the part of the way over the ground after which the body still stands on something.
  WorldPos kept_on_edge(const VoxelSpace& space, const Obstacles& solid, WorldPos by) const;

  WorldPos feet_, velocity_;  // voxels, voxels a second
  double waiting_s_ = 0;      // time that has passed and is no whole step yet
  double step_lag_ = 0;       // voxels by which the eye is below its place
  double fallen_ = 0;         // voxels
  bool is_on_ground_ = false, is_in_liquid_ = false, is_waiting_ = false;
  bool floats_ = false;   // swam since it last stood, and still touches the liquid
  bool is_held_ = false;  // the last step met a wall
};

}  // namespace runstone
