#include "client/display/body_marker.hpp"

#include "common/core/hash.hpp"

namespace runstone {
namespace {

constexpr double kHalfWidth = 0.3, kHeight = 1.8;
constexpr double kEyeHeight = 1.6;  // above the feet; a pose is at the eye
/// The corners of the near plane are farther from the eye than its middle, but less than twice as
/// far.
constexpr double kTooNear = 2 * Camera{}.near;

}  // namespace

std::optional<Marker> body_marker(AuthorId author, const WorldPos& at, const WorldPos& eye) {
  const auto near = [](double v, double from, double to) {
    return v > from - kTooNear && v < to + kTooNear;
  };
  const double feet = at.y - kEyeHeight;
  if (near(eye.x, at.x - kHalfWidth, at.x + kHalfWidth) && near(eye.y, feet, feet + kHeight) &&
      near(eye.z, at.z - kHalfWidth, at.z + kHalfWidth))
    return std::nullopt;
  const auto shade = [author](AuthorId channel) {
    return static_cast<std::uint8_t>(96 + mix64(author + channel) % 160);
  };
  return Marker{at.x - kHalfWidth, feet,     at.z - kHalfWidth, 2 * kHalfWidth, kHeight,
                2 * kHalfWidth,    shade(0), shade(1),          shade(2),       true};
}

}  // namespace runstone
