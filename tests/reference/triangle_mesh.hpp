// TriangleMesh: the mesh of the meshers that draw polygons instead of rectangles (thesis 4.2.10,
// 4.2.11).
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

/// Three indices of TriangleMesh::vertices, counter-clockwise seen from the side to which the
/// direction points.
struct MeshTriangle {
  std::array<std::uint32_t, 3> vertices{};
  Direction direction = Direction::neg_x;
  Material material = kEmpty;
  friend auto operator<=>(const MeshTriangle&, const MeshTriangle&) = default;
};

/// The triangles of one chunk, each in one layer of one direction. A drawn vertex has a normal and
/// a material, so triangles share it only within one layer, direction and material; elsewhere it is
/// repeated.
struct TriangleMesh {
  std::vector<MeshVertex> vertices;
  std::vector<MeshTriangle> triangles;

  void clear() {
    vertices.clear();
    triangles.clear();
  }
};

}  // namespace runstone::reference
