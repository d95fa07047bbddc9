#include "client/body/walker.hpp"

#include <algorithm>
#include <cmath>

namespace runstone {
namespace {

// Voxels and seconds. A jump reaches a height of 1.25 voxels.
constexpr double kGravity = 32, kJumpSpeed = 8.95, kFallSpeedMax = 60;
constexpr double kWalkSpeed = 4.5, kRunSpeed = 7.5;
constexpr double kSwimSpeed = 3, kWadeSpeed = 3.6, kSinkSpeed = 1.2, kRiseSpeed = 3.5;
// The share of the difference between speed and wish that is left after a second.
constexpr double kGroundGrip = 1e-8, kAirGrip = 0.05, kLiquidGrip = 1e-3;
constexpr double kLagShare =
    1e-5;  // the share of the eye's lag after a step up that is left after a second
constexpr double kUnstickSpeed = 3;    // of a body that is inside a solid voxel
constexpr double kUnstickWalkMax = 2;  // a body that is deeper inside is put above at once
constexpr int kUnstickSearchMax = 512;
constexpr double kSecondsMax = 0.25;
constexpr double kEdgeStep = 1.0 / 64;  // the precision with which a careful body stops at an edge

double towards(double now, double wish, double left_after_s) {
  return wish + (now - wish) * std::pow(left_after_s, kWalkStepS);
}

bool is_stopped(const Slide& slide, Direction direction) {
  return slide.is_stopped[static_cast<std::size_t>(direction)];
}

double length_over_ground(const WorldPos& way) { return std::hypot(way.x, way.z); }

/// Returns the slab of the body at this height above the feet, which is a hundredth of a voxel
/// thick.
BodyBox slab_at(const WorldPos& feet, double height) {
  BodyBox slab = body_at(feet);
  slab.min.y = feet.y + height;
  slab.max.y = slab.min.y + 0.01;
  return slab;
}

WorldPos sum(const WorldPos& a, const WorldPos& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

}  // namespace

BodyBox body_at(const WorldPos& feet) {
  constexpr double kHalf = kBodyWidth / 2;
  return {{feet.x - kHalf, feet.y, feet.z - kHalf},
          {feet.x + kHalf, feet.y + kBodyHeight, feet.z + kHalf}};
}

void Walker::place(WorldPos feet) { *this = Walker{}, feet_ = feet; }

void Walker::advance(const VoxelSpace& space, const BodyMaterials& materials,
                     const WalkInput& input, double seconds) {
  waiting_s_ += std::clamp(seconds, 0.0, kSecondsMax);
  for (; waiting_s_ >= kWalkStepS; waiting_s_ -= kWalkStepS) step(space, materials, input);
}

void Walker::step(const VoxelSpace& space, const BodyMaterials& materials, const WalkInput& input) {
  step_lag_ = towards(step_lag_, 0, kLagShare);
  is_waiting_ = !is_known(space, body_at(feet_));
  if (is_waiting_) {
    velocity_ = {};
    return;
  }
  if (overlaps(space, materials.solid, body_at(feet_))) return rise_out(space, materials.solid);
  is_in_liquid_ = overlaps(space, materials.liquid, body_at(feet_));
  const bool swims = is_in_liquid_ && overlaps(space, materials.liquid, slab_at(feet_, kSwimDepth));
  floats_ = swims || (floats_ && is_in_liquid_ && !is_on_ground_);
  const bool was_on_ground = is_on_ground_ && !input.up;
  accelerate(input, swims);
  WorldPos by{velocity_.x * kWalkStepS, velocity_.y * kWalkStepS, velocity_.z * kWalkStepS};
  if (was_on_ground && input.down && !floats_) by = kept_on_edge(space, materials.solid, by);
  const double before_y = feet_.y;
  move(space, materials.solid, by, was_on_ground || floats_);
  if (was_on_ground && !is_on_ground_ && !floats_) step_down(space, materials.solid);
  fallen_ = is_on_ground_ || is_in_liquid_ ? 0 : fallen_ + std::max(0.0, before_y - feet_.y);
}

void Walker::rise_out(const VoxelSpace& space, const Obstacles& solid) {
  velocity_ = {};
  fallen_ = 0;
  is_on_ground_ = false;
  // A voxel that somebody built at the feet lifts the body smoothly. The search goes on to the
  // first free place or to voxels that are not known yet.
  WorldPos free{feet_.x, std::floor(feet_.y) + 1, feet_.z};
  for (int i = 0; i < kUnstickSearchMax && is_known(space, body_at(free)); ++i, free.y += 1) {
    if (overlaps(space, solid, body_at(free))) continue;
    if (free.y - feet_.y > kUnstickWalkMax) return place(free);
    break;
  }
  feet_.y += kUnstickSpeed * kWalkStepS;
}

void Walker::accelerate(const WalkInput& input, bool swims) {
  const double speed = swims           ? kSwimSpeed
                       : is_in_liquid_ ? kWadeSpeed
                       : input.fast    ? kRunSpeed
                                       : kWalkSpeed;
  const double grip = swims ? kLiquidGrip : is_on_ground_ ? kGroundGrip : kAirGrip;
  velocity_.x = towards(velocity_.x, input.x * speed, grip);
  velocity_.z = towards(velocity_.z, input.z * speed, grip);
  if (swims) {
    const double wish = input.up ? kRiseSpeed : input.down ? -kRiseSpeed : -kSinkSpeed;
    velocity_.y = towards(velocity_.y, wish, kLiquidGrip);
  } else if (floats_ && input.up) {
    // At the surface the body floats. At a bank it jumps out.
    velocity_.y = is_held_ ? kJumpSpeed : towards(velocity_.y, 0, kLiquidGrip);
  } else if (is_on_ground_ && input.up) {
    velocity_.y = kJumpSpeed;
  } else {
    velocity_.y = std::max(velocity_.y - kGravity * kWalkStepS, -kFallSpeedMax);
  }
}

void Walker::move(const VoxelSpace& space, const Obstacles& solid, const WorldPos& by,
                  bool may_step_up) {
  Slide end = slide(space, solid, body_at(feet_), by);
  const double wanted = length_over_ground(by);
  if (may_step_up && length_over_ground(end.moved) < wanted - kTouchDepth) {
    // Tries the move from a higher place: up, along and down again. The result is used only if it
    // leads further.
    const Slide up = slide(space, solid, body_at(feet_), {0, kStepUpMax, 0});
    const WorldPos lifted = sum(feet_, up.moved);
    const Slide along = slide(space, solid, body_at(lifted), {by.x, 0, by.z});
    const WorldPos there = sum(lifted, along.moved);
    const Slide down = slide(space, solid, body_at(there), {0, -up.moved.y, 0});
    const bool is_further =
        length_over_ground(along.moved) > length_over_ground(end.moved) + kTouchDepth;
    if (is_further && is_stopped(down, Direction::neg_y)) {
      const double height = up.moved.y + down.moved.y;
      step_lag_ += height;
      end = along;
      end.moved.y = height;
      end.is_stopped[static_cast<std::size_t>(Direction::neg_y)] = true;
    }
  }
  feet_ = sum(feet_, end.moved);
  is_on_ground_ = is_stopped(end, Direction::neg_y);
  const bool is_held_x = is_stopped(end, Direction::neg_x) || is_stopped(end, Direction::pos_x);
  const bool is_held_z = is_stopped(end, Direction::neg_z) || is_stopped(end, Direction::pos_z);
  is_held_ = is_held_x || is_held_z;
  if (is_held_x) velocity_.x = 0;
  if (is_held_z) velocity_.z = 0;
  if (is_on_ground_ || is_stopped(end, Direction::pos_y)) velocity_.y = 0;
}

void Walker::step_down(const VoxelSpace& space, const Obstacles& solid) {
  const Slide down = slide(space, solid, body_at(feet_), {0, -kStepUpMax - kTouchDepth, 0});
  if (!is_stopped(down, Direction::neg_y)) return;
  feet_.y += down.moved.y;
  step_lag_ += down.moved.y;
  velocity_.y = 0;
  is_on_ground_ = true;
}

WorldPos Walker::kept_on_edge(const VoxelSpace& space, const Obstacles& solid, WorldPos by) const {
  const auto has_ground = [&](double x, double z) {
    const BodyBox there = body_at({feet_.x + x, feet_.y, feet_.z + z});
    return sweep(space, solid, there, {0, -kStepUpMax / 2, 0}).has_value();
  };
  const auto shorter = [](double way) {
    return std::abs(way) <= kEdgeStep ? 0 : way - std::copysign(kEdgeStep, way);
  };
  while (by.x != 0 && !has_ground(by.x, 0)) by.x = shorter(by.x);
  while (by.z != 0 && !has_ground(by.x, by.z)) by.z = shorter(by.z);
  return by;
}

}  // namespace runstone
