// PolygonJury: the meshers of polygons, monotone and Poly2Tri, before the triangle oracle.
#pragma once
#include <string>
#include <vector>

#include "common/materials/material_table.hpp"
#include "tests/reference/monotone_mesher.hpp"
#include "tests/reference/poly2tri_mesher.hpp"
#include "tests/support/mesh_scene.hpp"

namespace runstone::test {

/// Buffers live as long as the jury: what one scene leaves behind would show in the next.
class PolygonJury {
 public:
  /// What is wrong with the first wrong mesh of a scene whose exposed faces are `owed`, and whose it is; nothing
  /// if all is well. Of meshes that are right, both have to have the same vertices and as many triangles.
  std::string fault(const MeshScene& scene, const VisibilityTable& visibility,
                    const MaterialTable& materials, const std::vector<UnitFace>& owed);
  /// Of the last scene: corners in which a region touches itself.
  std::size_t touching_corners() const { return poly2tri_.polygons.touching_corners; }

 private:
  reference::MonotoneScratch monotone_;
  reference::Poly2TriScratch poly2tri_;
  reference::TriangleMesh monotone_mesh_, poly2tri_mesh_;
};

}  // namespace runstone::test
