// The common traversal of the polygon meshers: every layer of every direction is outlined, and each
// region is passed to the triangulation.
#pragma once
#include <array>
#include <cstdint>

#include "tests/reference/outlines.hpp"
#include "tests/reference/triangle_mesh.hpp"

namespace runstone::reference {

/// Buffers that are reused between calls, and counts of the last call. Thread: one.
struct PolygonScratch {
  FacePlane plane;
  OutlineTracer tracer;
  Outlines outlines;
  std::size_t regions = 0;
  std::size_t touching_regions = 0;  // regions that touch themselves at a corner or more
  std::size_t touching_corners = 0;
};

/// Replaces `out` by the triangles of every region of a grid. Triangulation has run(outlines,
/// region), then points() and triangles() of that region, counter-clockwise over u, v.
template <class Triangulation>
void mesh_polygons(const DenseGrid& grid, const VisibilityTable& visibility,
                   PolygonScratch& scratch, Triangulation& triangulation, TriangleMesh& out) {
  out.clear();
  scratch.regions = scratch.touching_regions = scratch.touching_corners = 0;
  each_face_plane(grid, visibility, scratch.plane, [&](Direction direction, std::uint32_t layer) {
    const auto axis = static_cast<std::size_t>(axis_of(direction));
    const bool positive = is_positive(direction);
    scratch.tracer.trace(scratch.plane, scratch.outlines);
    for (const Outlines::Region& region : scratch.outlines.regions) {
      ++scratch.regions;
      scratch.touching_regions += region.touching != 0 ? 1 : 0;
      scratch.touching_corners += region.touching;
      triangulation.run(scratch.outlines, region);
      const auto first = static_cast<std::uint32_t>(out.vertices.size());
      for (const LayerPoint& point : triangulation.points()) {
        std::array<std::uint8_t, 3> at{};
        at[axis] = static_cast<std::uint8_t>(layer + (positive ? 1 : 0));
        at[(axis + 1) % 3] = point.u;
        at[(axis + 2) % 3] = point.v;
        out.vertices.push_back({at[0], at[1], at[2]});
      }
      for (const auto& [a, b, c] : triangulation.triangles()) {
        out.triangles.push_back(
            {{first + a, first + (positive ? b : c), first + (positive ? c : b)},
             direction,
             region.material});
      }
    }
  });
}

}  // namespace runstone::reference
