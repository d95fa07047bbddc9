#include "client/body/walker.hpp"

#include <algorithm>
#include <cmath>

namespace runstone {
namespace {

// Voxels and seconds. A jump reaches a height of 1.25 voxels.
constexpr double kGravity = 32, kJumpSpeed = 8.95, kFallSpeedMax = 60;
constexpr double kWalkSpeed = 4.5, kRunSpeed = 7.5;
constexpr double kSwimSpeed = 3, kSinkSpeed = 1.2, kRiseSpeed = 3.5;
// The share of the difference between speed and wish that is left after a second.
constexpr double kGroundGrip = 1e-8, kAirGrip = 0.05, kLiquidGrip = 1e-3;
constexpr double kLagShare = 1e-5;   // of the eye's lag after a step up, likewise
constexpr double kUnstickSpeed = 3;  // of a body that is inside a solid voxel
constexpr double kSecondsMax = 0.25;
constexpr double kEdgeStep = 1.0 / 64;  // the precision with which a careful body stops at an edge

double towards(double now, double wish, double left_after_s) {
  return wish + (now - wish) * std::pow(left_after_s, kWalkStepS);
}

bool is_stopped(const Slide& slide, Direction direction) {
  return slide.is_stopped[static_cast<std::size_t>(direction)];
}

double length_over_ground(const WorldPos& way) { return std::hypot(way.x, way.z); }

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
  if (!is_known(space, body_at(feet_))) {
    velocity_ = {};
    return;
  }
  if (overlaps(space, materials.solid, body_at(feet_))) {
    velocity_ = {};
    is_on_ground_ = false;
    feet_.y += kUnstickSpeed * kWalkStepS;
    return;
  }
  is_in_liquid_ = overlaps(space, materials.liquid, body_at(feet_));
  const double speed = is_in_liquid_ ? kSwimSpeed : input.fast ? kRunSpeed : kWalkSpeed;
  const double grip = is_in_liquid_ ? kLiquidGrip : is_on_ground_ ? kGroundGrip : kAirGrip;
  velocity_.x = towards(velocity_.x, input.x * speed, grip);
  velocity_.z = towards(velocity_.z, input.z * speed, grip);
  if (is_in_liquid_) {
    const double wish = input.up ? kRiseSpeed : input.down ? -kRiseSpeed : -kSinkSpeed;
    velocity_.y = towards(velocity_.y, wish, kLiquidGrip);
  } else if (is_on_ground_ && input.up) {
    velocity_.y = kJumpSpeed;
  } else {
    velocity_.y = std::max(velocity_.y - kGravity * kWalkStepS, -kFallSpeedMax);
  }
  WorldPos by{velocity_.x * kWalkStepS, velocity_.y * kWalkStepS, velocity_.z * kWalkStepS};
  const bool is_careful = is_on_ground_ && input.down && !input.up && !is_in_liquid_;
  if (is_careful) by = kept_on_edge(space, materials.solid, by);
  move(space, materials.solid, by, (is_on_ground_ && !input.up) || is_in_liquid_);
}

void Walker::move(const VoxelSpace& space, const MaterialSet& solid, const WorldPos& by,
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
  if (is_stopped(end, Direction::neg_x) || is_stopped(end, Direction::pos_x)) velocity_.x = 0;
  if (is_stopped(end, Direction::neg_z) || is_stopped(end, Direction::pos_z)) velocity_.z = 0;
  if (is_on_ground_ || is_stopped(end, Direction::pos_y)) velocity_.y = 0;
}

WorldPos Walker::kept_on_edge(const VoxelSpace& space, const MaterialSet& solid,
                              WorldPos by) const {
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
