#include "common/voxelise/open_winding.hpp"

#include <algorithm>

namespace runstone {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Returns half the solid angle of the strip from a to b and along x to infinity; a and b are seen
/// from the point. Source: van Oosterom and Strackee 1983, with the third corner at infinity.
double half_angle(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  // The point moves by an infinitesimal along y, and by an infinitely smaller one along z. If it is
  // on the side of the strip that begins at a, a is seen in the direction of -y there, and the
  // strip is a lune.
  const auto is_behind = [](const std::array<double, 3>& corner) {
    return corner[1] == 0 && corner[2] == 0 && corner[0] < 0;
  };
  if (is_behind(a)) {
    if (b[1] == 0 && b[2] == 0) return 0;
    return b[2] != 0 || b[1] < 0 ? std::atan2(-b[2], -b[1]) : kPi;
  }
  if (is_behind(b)) {
    if (a[1] == 0 && a[2] == 0) return 0;
    return a[2] != 0 || a[1] < 0 ? std::atan2(a[2], -a[1]) : -kPi;
  }
  // Coordinates are whole and below 2^22, so this is exact.
  double volume = a[1] * b[2] - a[2] * b[1];
  if (volume == 0) {
    const double side = a[2] != b[2] ? a[2] - b[2] : b[1] - a[1];
    if (side == 0) return 0;
    volume = side > 0 ? 0.0 : -0.0;
  }
  const double length_a = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  const double length_b = std::sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
  const double rest = length_a * length_b + a[0] * b[0] + a[1] * b[1] + a[2] * b[2] +
                      a[0] * length_b + b[0] * length_a;
  return std::atan2(volume, rest);
}

}  // namespace

OpenWinding::Answer OpenWinding::look_at(const VoxelBlock& block) const {
  std::array<double, 3> centre{};
  double radius2 = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    centre[i] = (kVoxelUnit / 2) * double{1} * (block.low[i] + block.high[i]);
    const double reach = (kVoxelUnit / 2) * double{1} * (block.high[i] - block.low[i] - 1);
    radius2 += reach * reach;
  }
  const double radius = std::sqrt(radius2);
  const bool is_row = block.high[1] - block.low[1] == 1 && block.high[2] - block.low[2] == 1;
  double gradient = 0, sum = 0;
  bool meets_strip = false;
  for (const MeshEdges::Open& edge : edges_) {
    std::array<double, 3> a{}, b{};
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = edge.from[i] - centre[i];
      b[i] = edge.to[i] - centre[i];
    }
    if (radius > 0) {
      const std::array<double, 3> d{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
      const double length2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      const double share =
          std::clamp(-(a[0] * d[0] + a[1] * d[1] + a[2] * d[2]) / length2, 0.0, 1.0);
      double distance2 = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double v = a[i] + share * d[i];
        distance2 += v * v;
      }
      const double distance = std::sqrt(distance2) - radius;
      if (distance <= 1) return {};
      gradient += std::abs(edge.times) * std::sqrt(length2) / (distance * distance);
      // No value of the fraction is farther than a half from a half.
      if (radius * gradient >= 2 * kPi) return {};
      if (!is_row && !meets_strip) {
        bool meets = true;
        for (std::size_t i = 1; i < 3; ++i) {
          const double reach = (kVoxelUnit / 2) * double{1} * (block.high[i] - block.low[i] - 1);
          meets = meets && std::min(a[i], b[i]) <= reach && std::max(a[i], b[i]) >= -reach;
        }
        meets_strip = meets;
      }
    }
    sum += edge.times * half_angle(a, b);
  }
  const double offset = sum / (2 * kPi);
  const double from_half = std::abs(offset - std::floor(offset) - 0.5);
  if (radius > 0 && from_half <= radius * gradient / (4 * kPi)) return {};
  if (meets_strip) return {std::nullopt, 1};
  return {offset, 0};
}

}  // namespace runstone
