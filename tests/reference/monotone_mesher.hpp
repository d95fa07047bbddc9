// The monotone mesher (thesis 4.2.10; Lysenko 2012, "Meshing in a Minecraft Game, part 2"). The
// faces of a layer are polygons. A sweep over rows cuts them into monotone ones, and each of those
// is triangulated in linear time.
//
// Lysenko's sweep starts and ends a polygon at whole rows of faces, with vertices where nothing
// bends. This one joins corners with corners (monotone_triangulation.hpp). So there are no vertices
// but the corners of the regions, and within a region no T-junctions. Its known defect remains:
// beside a region of another material, and between layers of different directions, a corner of one
// lies within a side of the other.
#pragma once
#include "tests/reference/monotone_triangulation.hpp"
#include "tests/reference/polygon_layers.hpp"

namespace runstone::reference {

struct MonotoneScratch {
  PolygonScratch polygons;
  MonotoneTriangulation triangulation;
};

/// Replaces `out` by the exposed faces of `grid`, by direction, layer and region. Cost: O(volume +
/// corners log corners).
inline void mesh_monotone(const DenseGrid& grid, const VisibilityTable& visibility,
                          MonotoneScratch& scratch, TriangleMesh& out) {
  mesh_polygons(grid, visibility, scratch.polygons, scratch.triangulation, out);
}

}  // namespace runstone::reference
