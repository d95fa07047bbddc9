// Aim: the place at which a player points, and the held material.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client/replica/ray_pick.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

struct Aim {
  WorldPos eye;
  LookDirection look;
  std::optional<RayHit> hit;  // nullopt if nothing is in reach
  Material held = kEmpty;
};

/// A voxel and a face of it at which a script aims, instead of the player's look.
struct FixedAim {
  VoxelPos voxel;
  Direction face = Direction::pos_y;
};

/// The two mouse buttons. `clear` removes voxels, and `place` sets the held material.
enum class ToolButton : std::uint8_t { clear, place };

/// Places of a tool that are given by their coordinates instead of by clicks.
struct TypedPlaces {
  ToolButton button = ToolButton::place;
  std::vector<VoxelPos> places;
  Direction face = Direction::pos_y;  // of the last place, for tools that work on a face
  friend bool operator==(const TypedPlaces&, const TypedPlaces&) = default;
};

/// Returns the voxel on the ray at a distance from the eye. Requires a distance below 4096 and an
/// eye inside the world.
VoxelPos voxel_on_ray(const Aim& aim, double distance);

/// Returns the distance from the eye to the centre of a voxel.
double distance_to(const Aim& aim, VoxelPos voxel);

/// Returns how far two places lie apart along the axis on which they lie farthest apart, as
/// kStrokeStepMax bounds it. Requires places inside the world.
std::int32_t stroke_step(VoxelPos from, VoxelPos to);

/// Returns the direction along x or z that is nearest to a look.
Direction horizontal_look(const LookDirection& look);
/// Returns the direction to the right of horizontal_look().
Direction horizontal_right(const LookDirection& look);

/// Fails with words for the player if consecutive places are more than kStrokeStepMax apart: places
/// that are typed may be anywhere in the world, and a curve has points all along its way.
Result<void, std::string> check_steps(std::span<const VoxelPos> places);

/// Returns the box with these corners, both included.
VoxelBox box_between(VoxelPos a, VoxelPos b);

/// Returns the sides of a box.
VoxelPos sides_of(const VoxelBox& box);

/// Returns the voxel `steps` steps away in a direction.
VoxelPos moved(VoxelPos voxel, Direction direction, std::int32_t steps);
VoxelBox moved(const VoxelBox& box, Direction direction, std::int32_t steps);

}  // namespace runstone
