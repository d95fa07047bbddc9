#include "bench/meshing/mesh_figures.hpp"

namespace runstone::bench {

MeshFigures figures_of(const reference::Surface& surface) {
  const reference::TriangleMesh& mesh = surface.triangles;
  MeshFigures out;
  out.bytes = surface.quads.size() * sizeof(Quad) +
              mesh.vertices.size() * sizeof(reference::MeshVertex) +
              mesh.triangles.size() * sizeof(reference::MeshTriangle);
  out.vertices = surface.vertex_count();
  out.triangles = surface.triangle_count();
  out.t_junctions = reference::count_t_junctions(surface);
  out.thin = reference::count_thin_triangles(surface);
  return out;
}

}  // namespace runstone::bench
