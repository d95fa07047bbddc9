#include "client/play/player.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace runstone {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPitchMax = kPi / 2 - 0.01;  // looking straight up has no forward direction
constexpr double kRadiansPerPixel = 0.0025;
constexpr double kSpeed = 12;  // voxels a second, of flight at first
constexpr double kFastFactor = 5;
constexpr int kSpeedStepMin = -3, kSpeedStepMax = 3;

/// Returns the direction over the ground of the keys that are pressed, of length 1 at most.
WalkInput over_ground(const WindowInput& input, double yaw) {
  const double forward = (input.forward ? 1 : 0) - (input.back ? 1 : 0);
  const double right = (input.right ? 1 : 0) - (input.left ? 1 : 0);
  const double scale = forward != 0 && right != 0 ? std::numbers::sqrt2 / 2 : 1;
  const double sine = std::sin(yaw), cosine = std::cos(yaw);
  WalkInput out;
  // In right-handed coordinates with y up, -x is to the right of +z.
  out.x = (forward * sine - right * cosine) * scale;
  out.z = (forward * cosine + right * sine) * scale;
  return out;
}

}  // namespace

void Player::enter(const WorldId& world, const WorldPos& spawn, const std::optional<Pose>& place) {
  spawn_ = spawn;
  if (world_ == world) return;
  world_ = world;
  move_to(place ? place->at : spawn);
  if (place) look(yaw_of(*place), pitch_of(*place));
}

void Player::move_to(const WorldPos& eye) {
  eye_ = eye;
  walker_.place_eye(eye);
}

void Player::set_walking(bool is_walking) {
  is_walking_ = is_walking;
  walker_.place_eye(eye_);
}

bool Player::is_in(VoxelPos voxel) const {
  const BodyBox body = is_walking_ ? body_at(walker_.feet()) : BodyBox{eye_, eye_};
  const auto overlaps = [](double min, double max, std::int32_t at) {
    return min < at + 1.0 - kTouchDepth && max > at + kTouchDepth;
  };
  return overlaps(body.min.x, body.max.x, voxel.x) && overlaps(body.min.y, body.max.y, voxel.y) &&
         overlaps(body.min.z, body.max.z, voxel.z);
}

void Player::look(double yaw, double pitch) {
  yaw_ = std::remainder(yaw, 2 * kPi);
  pitch_ = std::clamp(pitch, -kPitchMax, kPitchMax);
}

Pose Player::pose() const {
  Pose pose;
  pose.at = eye_;
  const double turns = yaw_ / (2 * kPi);
  pose.yaw = static_cast<std::uint16_t>(std::llround((turns - std::floor(turns)) * 65536) & 65535);
  pose.pitch = static_cast<std::int16_t>(std::lround(pitch_ / kPi * 32768));
  return pose;
}

double yaw_of(const Pose& pose) { return pose.yaw / 65536.0 * 2 * kPi; }

double pitch_of(const Pose& pose) { return pose.pitch / 32768.0 * kPi; }

Camera Player::camera(double view_voxels) const {
  Camera camera;
  camera.x = eye_.x;
  camera.y = eye_.y;
  camera.z = eye_.z;
  camera.yaw = yaw_;
  camera.pitch = pitch_;
  camera.far = std::max(64.0, view_voxels);
  return camera;
}

VoxelPos Player::voxel() const {
  const auto down = [](double v) {
    if (std::isnan(v)) return 0;
    return static_cast<std::int32_t>(
        std::floor(std::clamp<double>(v, -kWorldLimit, kWorldLimit - 1)));
  };
  return {down(eye_.x), down(eye_.y), down(eye_.z)};
}

void Player::turn(const WindowInput& input) {
  // Moving the mouse right lowers the yaw, because -x is to the right of +z.
  look(yaw_ - input.look_dx * kRadiansPerPixel, pitch_ - input.look_dy * kRadiansPerPixel);
}

void Player::fly(const WindowInput& input, double seconds) {
  const WalkInput way = over_ground(input, yaw_);
  const double distance = flying_speed() * (input.fast ? kFastFactor : 1) * seconds;
  eye_.x += way.x * distance;
  eye_.z += way.z * distance;
  eye_.y += ((input.up ? 1 : 0) - (input.down ? 1 : 0)) * distance;
}

void Player::walk(const WindowInput& input, double seconds, const VoxelSpace& space,
                  const BodyMaterials& materials) {
  WalkInput way = over_ground(input, yaw_);
  way.up = input.up;
  way.down = input.down;
  way.fast = input.fast;
  walker_.advance(space, materials, way, seconds);
  eye_ = walker_.eye();
  if (walker_.fallen() < kFallMax) return;
  move_to(spawn_);
  set_walking(false);
  has_fallen_out_ = true;
}

double Player::flying_speed() const { return std::ldexp(kSpeed, speed_step_); }

void Player::change_flying_speed(int steps) {
  speed_step_ = std::clamp(speed_step_ + steps, kSpeedStepMin, kSpeedStepMax);
}

}  // namespace runstone
