#include "server/interest/view_order.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace runstone {
namespace {

// A place, from the highest bit: ring, squared distance, and the offsets x, y, z from the centre of
// the view, each with kBias added.
constexpr int kOffsetBits = 9, kDistanceBits = 18;
constexpr std::int64_t kBias = 1 << (kOffsetBits - 1);
constexpr std::int64_t kRadiusMax = std::numeric_limits<decltype(View::radius_h)>::max();
static_assert(kRadiusMax < kBias && 2 * kRadiusMax * kRadiusMax < 1 << kDistanceBits);

}  // namespace

ViewOrder::ViewOrder(const View& view) : centre_(view.centre), has_cone_(view.cone != 0) {
  constexpr double kTurn = 65'536;
  const auto angle = [](double units) { return units / kTurn * 2 * std::numbers::pi; };
  const double level = std::cos(angle(view.pitch));
  x_ = std::sin(angle(view.yaw)) * level;
  y_ = std::sin(angle(view.pitch));
  z_ = std::cos(angle(view.yaw)) * level;
  cosine_ = std::cos(angle(view.cone));
}

ViewOrder::Ring ViewOrder::ring(std::int64_t dx, std::int64_t dy, std::int64_t dz,
                                std::int64_t distance2) const {
  if (!has_cone_ || distance2 <= kNear2) return Ring::near;
  const double along =
      static_cast<double>(dx) * x_ + static_cast<double>(dy) * y_ + static_cast<double>(dz) * z_;
  return along >= cosine_ * std::sqrt(static_cast<double>(distance2)) ? Ring::seen : Ring::rest;
}

ViewOrder::Place ViewOrder::place_of(ChunkCoord at) const {
  const std::int64_t dx = std::int64_t{at.x} - centre_.x;
  const std::int64_t dy = std::int64_t{at.y} - centre_.y;
  const std::int64_t dz = std::int64_t{at.z} - centre_.z;
  const std::int64_t distance2 = dx * dx + dy * dy + dz * dz;
  auto place = static_cast<Place>(ring(dx, dy, dz, distance2));
  place = place << kDistanceBits | static_cast<Place>(distance2);
  for (const std::int64_t offset : {dx, dy, dz})
    place = place << kOffsetBits | static_cast<Place>(offset + kBias);
  return place;
}

ChunkCoord ViewOrder::chunk_at(Place place) const {
  const auto offset = [place](int axis) {
    constexpr Place kMask = (1 << kOffsetBits) - 1;
    return static_cast<std::int32_t>(
        static_cast<std::int64_t>(place >> (2 - axis) * kOffsetBits & kMask) - kBias);
  };
  return {centre_.x + offset(0), centre_.y + offset(1), centre_.z + offset(2)};
}

}  // namespace runstone
