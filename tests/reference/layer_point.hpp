// LayerPoint: a corner in a layer of faces, and the two exact predicates of triangulations.
#pragma once
#include <cstdint>

namespace runstone::reference {

/// A point of the lattice of corners, 0 .. 128. u and v are those of quads (common/mesh/quad.hpp).
struct LayerPoint {
  std::uint8_t u = 0, v = 0;
  friend constexpr bool operator==(const LayerPoint&, const LayerPoint&) = default;
  /// The order of a sweep: row by row, along u in a row.
  friend constexpr bool operator<(const LayerPoint& a, const LayerPoint& b) {
    return a.v != b.v ? a.v < b.v : a.u < b.u;
  }
};

/// Returns twice the area of a b c: positive if they turn left (counter-clockwise), 0 on a line.
constexpr std::int32_t turn(LayerPoint a, LayerPoint b, LayerPoint c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

/// Returns a positive number if d lies within the circle through a b c, 0 on it. Requires turn(a,
/// b, c) > 0. Exact: below 2^34.
constexpr std::int64_t in_circle(LayerPoint a, LayerPoint b, LayerPoint c, LayerPoint d) {
  const std::int64_t au = a.u - d.u, av = a.v - d.v, bu = b.u - d.u, bv = b.v - d.v, cu = c.u - d.u,
                     cv = c.v - d.v;
  const std::int64_t aa = au * au + av * av, bb = bu * bu + bv * bv, cc = cu * cu + cv * cv;
  return aa * (bu * cv - bv * cu) - bb * (au * cv - av * cu) + cc * (au * bv - av * bu);
}

}  // namespace runstone::reference
