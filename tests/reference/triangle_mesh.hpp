// TriangleMesh: what the meshers make that draw polygons instead of rectangles (thesis 4.2.10, 4.2.11).
#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone::reference {

/// A corner on the voxel lattice, 0 .. 128 on each axis.
struct MeshVertex {
  std::uint8_t x = 0, y = 0, z = 0;
  friend auto operator<=>(const MeshVertex&, const MeshVertex&) = default;
};

/// Three places in TriangleMesh::vertices, counter-clockwise seen from where the direction points.
struct MeshTriangle {
  std::array<std::uint32_t, 3> vertices{};
  Direction direction = Direction::neg_x;
  Material material = kEmpty;
  friend auto operator<=>(const MeshTriangle&, const MeshTriangle&) = default;
};

/// Triangles of one chunk, each in one layer of one direction. A vertex carries a normal and a material where
/// it is drawn, so triangles share it only within one layer, direction and material; elsewhere it stands
/// there again.
struct TriangleMesh {
  std::vector<MeshVertex> vertices;
  std::vector<MeshTriangle> triangles;

  void clear() {
    vertices.clear();
    triangles.clear();
  }
};

}  // namespace runstone::reference
