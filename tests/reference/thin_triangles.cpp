#include "tests/reference/thin_triangles.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "tests/reference/each_polygon.hpp"

namespace runstone::reference {
namespace {

std::int64_t squared_length(const Corner& from, const Corner& to) {
  std::int64_t sum = 0;
  for (std::size_t a = 0; a < 3; ++a) sum += std::int64_t{to[a] - from[a]} * (to[a] - from[a]);
  return sum;
}

/// Returns the length of the cross product of two sides. All but one of its components are 0, since
/// triangles are perpendicular to an axis.
std::int64_t doubled_area(const Corner& a, const Corner& b, const Corner& c) {
  std::int64_t sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    sum += std::abs(std::int64_t{b[u] - a[u]} * (c[v] - a[v]) -
                    std::int64_t{b[v] - a[v]} * (c[u] - a[u]));
  }
  return sum;
}

}  // namespace

ThinTriangles count_thin_triangles(const Surface& surface) {
  ThinTriangles out;
  const auto add = [&out](const Corner& a, const Corner& b, const Corner& c) {
    // Length over height is squared length over doubled area.
    const std::int64_t longest =
        std::max({squared_length(a, b), squared_length(b, c), squared_length(c, a)});
    const std::int64_t area = doubled_area(a, b, c);
    out.above_16 += longest > 16 * area ? 1 : 0;
    out.above_100 += longest > 100 * area ? 1 : 0;
  };
  each_polygon(surface, [&](std::span<const Corner> corners) {
    for (std::size_t i = 2; i < corners.size(); ++i) add(corners[0], corners[i - 1], corners[i]);
  });
  return out;
}

}  // namespace runstone::reference
