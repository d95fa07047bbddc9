// The traversal of the polygons of a surface, quads and triangles alike.
#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "common/mesh/quad_corners.hpp"
#include "tests/reference/surface.hpp"

namespace runstone::reference {

/// Calls visit(corners) for every quad and triangle of a surface: 4 or 3 corners in drawing order.
template <class F>
void each_polygon(const Surface& surface, F&& visit) {
  for (const Quad quad : surface.quads) {
    const std::array<Corner, 4> corners = quad_corners(quad);
    visit(std::span<const Corner>(corners));
  }
  for (const MeshTriangle& triangle : surface.triangles.triangles) {
    std::array<Corner, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const MeshVertex& vertex = surface.triangles.vertices[triangle.vertices[i]];
      corners[i] = {vertex.x, vertex.y, vertex.z};
    }
    visit(std::span<const Corner>(corners));
  }
}

}  // namespace runstone::reference
