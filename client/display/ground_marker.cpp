#include "client/display/ground_marker.hpp"

#include <algorithm>
#include <utility>

namespace runstone {

std::optional<Marker> ground_marker(const GroundBox& box, const WorldPos& eye, double far) {
  // Of a range that reaches farther, the part up to twice the distance is kept.
  const auto range = [far](std::int32_t min, std::int32_t max,
                           double at) -> std::optional<std::pair<double, double>> {
    if (min > at + far || max < at - far) return std::nullopt;
    return std::pair(std::max<double>(min, at - 2 * far), std::min<double>(max, at + 2 * far));
  };
  const auto x = range(box.box.min.x, box.box.max.x, eye.x);
  const auto y = range(box.box.min.y, box.box.max.y, eye.y);
  const auto z = range(box.box.min.z, box.box.max.z, eye.z);
  if (!x || !y || !z) return std::nullopt;
  Marker out{x->first,
             y->first,
             z->first,
             x->second - x->first,
             y->second - y->first,
             z->second - z->first,
             230,
             50,
             40,
             false,
             !box.admits};
  if (box.admits) out.r = 50, out.g = 200, out.b = 80;
  return out;
}

}  // namespace runstone
