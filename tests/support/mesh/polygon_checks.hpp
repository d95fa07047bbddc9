// PolygonChecks: checks the meshers of polygons, monotone and Poly2Tri, with the triangle oracle.
#pragma once
#include <string>
#include <vector>

#include "common/materials/material_table.hpp"
#include "tests/reference/monotone_mesher.hpp"
#include "tests/reference/poly2tri_mesher.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {

/// The buffers live as long as the object, so that the remains of one scene would show in the next.
class PolygonChecks {
 public:
  /// Returns the first mesher with a wrong mesh of the scene and its fault, or an empty text.
  /// `owed` are the scene's exposed faces. Both meshers must have the same vertices and the same
  /// number of triangles.
  std::string fault(const MeshScene& scene, const VisibilityTable& visibility,
                    const MaterialTable& materials, const std::vector<UnitFace>& owed);
  /// Returns the corners of the last scene at which a region touches itself.
  std::size_t touching_corners() const { return poly2tri_.polygons.touching_corners; }

 private:
  reference::MonotoneScratch monotone_;
  reference::Poly2TriScratch poly2tri_;
  reference::TriangleMesh monotone_mesh_, poly2tri_mesh_;
};

}  // namespace runstone::test
