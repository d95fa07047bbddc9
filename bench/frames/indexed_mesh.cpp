#include "bench/frames/indexed_mesh.hpp"

#include "common/mesh/quad_corners.hpp"

namespace runstone::bench {

void index_surface(const reference::Surface& surface, IndexedMesh& out) {
  out.vertices.clear();
  out.indices.clear();
  out.vertices.reserve(surface.vertex_count());
  out.indices.reserve(3 * surface.triangle_count());
  for (const Quad quad : surface.quads) {
    const QuadFields fields = unpack(quad);
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    for (const Corner& corner : quad_corners(quad)) {
      out.vertices.push_back(
          {static_cast<std::uint8_t>(corner[0]), static_cast<std::uint8_t>(corner[1]),
           static_cast<std::uint8_t>(corner[2]), fields.direction, fields.material});
    }
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u})
      out.indices.push_back(first + corner);
  }
  const auto first = static_cast<std::uint32_t>(out.vertices.size());
  for (const reference::MeshVertex& v : surface.triangles.vertices) {
    out.vertices.push_back({v.x, v.y, v.z});
  }
  // Triangles share a vertex only if they have one direction and material, so any of them gives its
  // attributes.
  for (const reference::MeshTriangle& triangle : surface.triangles.triangles) {
    for (const std::uint32_t vertex : triangle.vertices) {
      out.vertices[first + vertex].direction = triangle.direction;
      out.vertices[first + vertex].material = triangle.material;
      out.indices.push_back(first + vertex);
    }
  }
}

}  // namespace runstone::bench
