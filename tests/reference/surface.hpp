// Surface: any mesher's mesh of one chunk, quads or triangles, so that meshes of both kinds can be
// counted and compared.
#pragma once
#include <cstddef>
#include <vector>

#include "common/mesh/quad.hpp"
#include "tests/reference/triangle_mesh.hpp"

namespace runstone::reference {

/// A mesher fills one of the two lists and clears the other.
struct Surface {
  std::vector<Quad> quads;
  TriangleMesh triangles;

  void clear() {
    quads.clear();
    triangles.clear();
  }
  /// Returns 4 a quad, as the thesis counts, or the vertices of the triangle mesh.
  std::size_t vertex_count() const { return 4 * quads.size() + triangles.vertices.size(); }
  /// Returns 2 a quad, or the triangles of the triangle mesh.
  std::size_t triangle_count() const { return 2 * quads.size() + triangles.triangles.size(); }
};

}  // namespace runstone::reference
