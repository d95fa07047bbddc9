#include "tests/support/mesh/polygon_checks.hpp"

#include "tests/support/mesh/triangle_oracle.hpp"

namespace runstone::test {

std::string PolygonChecks::fault(const MeshScene& scene, const VisibilityTable& visibility,
                                 const MaterialTable& materials,
                                 const std::vector<UnitFace>& owed) {
  const reference::DenseGrid grid = grid_of(scene);
  const Extent extent = scene.chunk.extent;
  mesh_monotone(grid, visibility, monotone_, monotone_mesh_);
  if (const auto wrong = triangles_difference(monotone_mesh_, extent, materials, owed)) {
    return "monotone: " + *wrong;
  }
  mesh_poly2tri(grid, visibility, poly2tri_, poly2tri_mesh_);
  if (const auto wrong = triangles_difference(poly2tri_mesh_, extent, materials, owed)) {
    return "poly2tri: " + *wrong;
  }
  // All triangulations of a polygon without new points have the same number of triangles.
  if (monotone_mesh_.vertices != poly2tri_mesh_.vertices) return "the meshers have other vertices";
  if (monotone_mesh_.triangles.size() != poly2tri_mesh_.triangles.size())
    return "the meshers differ in size";
  return {};
}

}  // namespace runstone::test
