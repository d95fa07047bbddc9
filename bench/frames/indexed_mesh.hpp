// IndexedMesh: any mesher's polygons in the one form in which all are uploaded: 8 bytes a vertex
// and three 4-byte indices a triangle. Pictures and frame times of two meshers then differ by their
// geometry alone.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/reference/surface.hpp"

namespace runstone::bench {

/// A corner on the voxel lattice of a chunk, 0 .. 128 on each axis, with the attributes of its
/// face.
struct IndexedVertex {
  std::uint8_t x = 0, y = 0, z = 0;
  Direction direction = Direction::neg_x;
  Material material = kEmpty;
  std::uint16_t padding = 0;  // to 8 bytes
  friend auto operator<=>(const IndexedVertex&, const IndexedVertex&) = default;
};
static_assert(sizeof(IndexedVertex) == 8);

struct IndexedMesh {
  std::vector<IndexedVertex> vertices;
  std::vector<std::uint32_t> indices;  // three a triangle, counter-clockwise seen from outside

  std::size_t byte_size() const {
    return vertices.size() * sizeof(IndexedVertex) + indices.size() * sizeof(std::uint32_t);
  }
};

/// Replaces `out` by a surface: four vertices and two triangles a quad; a triangle mesh keeps its
/// shared vertices.
void index_surface(const reference::Surface& surface, IndexedMesh& out);

}  // namespace runstone::bench
