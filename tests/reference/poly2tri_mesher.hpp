// The Poly2Tri mesher (thesis 4.2.11): the outlines of the faces of a layer, and their constrained
// Delaunay triangulation, which adds no vertices. The library of that name is not used:
// sweep_delaunay.hpp describes the common parts and the differences.
//
// The original rejects outlines that touch each other or themselves. Here they are allowed
// (PolygonScratch counts their regions). T-junctions between layers and materials remain, as in the
// original.
#pragma once
#include "tests/reference/polygon_layers.hpp"
#include "tests/reference/sweep_delaunay.hpp"

namespace runstone::reference {

struct Poly2TriScratch {
  PolygonScratch polygons;
  SweepDelaunay triangulation;
};

/// Replaces `out` by the exposed faces of `grid`, by direction, layer and region. Cost: O(volume +
/// corners log corners + flips).
inline void mesh_poly2tri(const DenseGrid& grid, const VisibilityTable& visibility,
                          Poly2TriScratch& scratch, TriangleMesh& out) {
  mesh_polygons(grid, visibility, scratch.polygons, scratch.triangulation, out);
}

}  // namespace runstone::reference
