#include "bench/view/gl/view_camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace runstone::bench {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kFovY = 0.6;            // radians; narrow, so that near and far look alike
constexpr double kTurnPerPixel = 0.006;  // radians

}  // namespace

ViewCamera::ViewCamera(const std::array<int, 3>& low, const std::array<int, 3>& high, double turn,
                       double pitch)
    : radius_(std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2),
      turn_(turn * kDegree),
      pitch_(pitch * kDegree) {
  for (std::size_t i = 0; i < 3; ++i) middle_[i] = (low[i] + high[i]) / 2.0;
}

Camera ViewCamera::camera() const {
  const double distance = distance_ * radius_ / std::sin(kFovY / 2);
  Camera out;
  out.yaw = turn_;
  out.pitch = -pitch_;
  out.fov_y = kFovY;
  out.x = middle_[0] - distance * std::sin(out.yaw) * std::cos(out.pitch);
  out.y = middle_[1] - distance * std::sin(out.pitch);
  out.z = middle_[2] - distance * std::cos(out.yaw) * std::cos(out.pitch);
  out.near = std::max(0.1, distance - 1.1 * radius_);
  out.far = 4 * (distance + radius_);  // the chunks lie before the fog
  return out;
}

bool ViewCamera::feed(std::span<const InputEvent> events) {
  bool has_moved = false;
  for (const InputEvent& event : events) {
    if (const auto* button = std::get_if<ButtonEvent>(&event);
        button != nullptr && button->button == MouseButton::left)
      is_held_ = button->is_pressed;
    if (const auto* cursor = std::get_if<CursorEvent>(&event); cursor != nullptr && is_held_) {
      turn_ += cursor->dx * kTurnPerPixel;
      pitch_ = std::clamp(pitch_ + cursor->dy * kTurnPerPixel, -89 * kDegree, 89 * kDegree);
      has_moved = true;
    }
    if (const auto* wheel = std::get_if<WheelEvent>(&event)) {
      distance_ = std::clamp(distance_ * std::pow(0.9, wheel->steps), 0.05, 4.0);
      has_moved = true;
    }
  }
  return has_moved;
}

}  // namespace runstone::bench
