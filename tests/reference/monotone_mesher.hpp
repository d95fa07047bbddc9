// The monotone mesher (thesis 4.2.10; Lysenko 2012, "Meshing in a Minecraft Game, part 2"): the faces of a
// layer as polygons, cut into monotone ones by a sweep over rows, each of which is triangulated in linear time.
//
// Lysenko's sweep starts and ends a polygon at whole rows of faces, with vertices where nothing bends; ours
// joins corners with corners (monotone_triangulation.hpp). So there are no vertices but the corners of the
// regions, and within a region no T-junctions. Its known defect stays: beside a region of another material, and
// between layers of different directions, a corner of one lies within a side of the other.
#pragma once
#include "tests/reference/monotone_triangulation.hpp"
#include "tests/reference/polygon_layers.hpp"

namespace runstone::reference {

struct MonotoneScratch {
  PolygonScratch polygons;
  MonotoneTriangulation triangulation;
};

/// Replaces `out` by the exposed faces of `grid`, by direction, layer and region. O(volume + corners log
/// corners).
inline void mesh_monotone(const DenseGrid& grid, const VisibilityTable& visibility,
                          MonotoneScratch& scratch, TriangleMesh& out) {
  mesh_polygons(grid, visibility, scratch.polygons, scratch.triangulation, out);
}

}  // namespace runstone::reference
