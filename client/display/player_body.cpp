#include "client/display/player_body.hpp"

#include <array>
#include <cstdint>
#include <numbers>

#include "client/render/author_rgb.hpp"
#include "client/render/renderer.hpp"

namespace runstone {
namespace {

constexpr double kHalfWidth = 0.3, kHeight = 1.8;
constexpr double kEyeHeight = 1.6;  // above the feet; a pose is at the eye
/// The corners of the near plane are farther from the eye than its middle, but less than twice as
/// far.
constexpr double kTooNear = 2 * Camera{}.near;

}  // namespace

std::optional<Body> player_body(AuthorId author, const Pose& pose, const WorldPos& eye) {
  const WorldPos& at = pose.at;
  const auto near = [](double v, double from, double to) {
    return v > from - kTooNear && v < to + kTooNear;
  };
  const double feet = at.y - kEyeHeight;
  if (near(eye.x, at.x - kHalfWidth, at.x + kHalfWidth) && near(eye.y, feet, feet + kHeight) &&
      near(eye.z, at.z - kHalfWidth, at.z + kHalfWidth))
    return std::nullopt;
  const std::array<std::uint8_t, 3> colour = author_rgb(author);
  return Body{at.x,
              feet,
              at.z,
              pose.yaw * (2 * std::numbers::pi / 65536),
              pose.pitch * (std::numbers::pi / 32768),
              colour[0],
              colour[1],
              colour[2]};
}

}  // namespace runstone
