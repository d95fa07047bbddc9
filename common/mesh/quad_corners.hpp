// The four corners of a quad in drawing order. The renderer's vertex shader computes them from
// the packed bits. This copy on the CPU lets tests compare the winding of both.
#pragma once
#include <array>
#include <cstddef>

#include "common/mesh/quad.hpp"

namespace runstone {

/// A corner on the voxel lattice, 0 .. 128 on each axis, by Axis.
using Corner = std::array<int, 3>;

/// Returns the corners in counter-clockwise order seen from outside, that is, from the side to
/// which the direction points. The first is the corner with the smallest coordinates. (corner 1 -
/// corner 0) x (corner 2 - corner 1) points along the direction. Triangles are (0, 1, 2) and (0, 2,
/// 3).
constexpr std::array<Corner, 4> quad_corners(Quad quad) {
  const QuadFields q = unpack(quad);
  const Axis axis = axis_of(q.direction);
  const auto u = static_cast<std::size_t>(u_axis_of(axis));
  const auto v = static_cast<std::size_t>(v_axis_of(axis));
  const bool positive = is_positive(q.direction);

  Corner low = {q.x, q.y, q.z};
  if (positive) ++low[static_cast<std::size_t>(axis)];  // the far side of the voxels
  std::array<Corner, 4> corners = {low, low, low, low};
  corners[positive ? 1 : 3][u] += q.width;
  corners[2][u] += q.width;
  corners[2][v] += q.height;
  corners[positive ? 3 : 1][v] += q.height;
  return corners;
}

}  // namespace runstone
