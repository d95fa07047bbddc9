// FacePlane: the drawn faces of one direction in one layer, as materials in rows. Every mesher that
// merges within a layer reads it and removes faces from it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/ids.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/reference/dense_grid.hpp"
#include "tests/reference/voxel_faces.hpp"

namespace runstone::reference {

struct FacePlane {
  std::uint32_t width = 0, height = 0;  // faces along u and v (common/mesh/quad.hpp)
  std::vector<Material> faces;          // row after row, u along a row; kEmpty: no face

  Material* row(std::uint32_t v) { return faces.data() + static_cast<std::size_t>(v) * width; }
  const Material* row(std::uint32_t v) const {
    return faces.data() + static_cast<std::size_t>(v) * width;
  }
};

/// A rectangle of equal faces of a plane.
struct PlaneRectangle {
  std::uint32_t u = 0, v = 0;           // of its first face
  std::uint32_t width = 1, height = 1;  // faces along u and v
  Material material = kEmpty;
  friend bool operator==(const PlaneRectangle&, const PlaneRectangle&) = default;
};

/// Replaces `plane` by the drawn faces of `direction` in `layer`. Returns true if there are any.
/// Cost: O(faces of a layer).
inline bool read_faces(const DenseGrid& grid, const VisibilityTable& visibility,
                       Direction direction, std::uint32_t layer, FacePlane& plane) {
  const Axis across = axis_of(direction);
  const Axis u = u_axis_of(across);
  const Axis v = v_axis_of(across);
  const auto sides = grid.extent().sides();
  plane.width = sides[static_cast<std::size_t>(u)];
  plane.height = sides[static_cast<std::size_t>(v)];
  plane.faces.resize(static_cast<std::size_t>(plane.width) * plane.height);
  const std::ptrdiff_t beside = is_positive(direction) ? grid.stride(across) : -grid.stride(across);
  const std::ptrdiff_t along_u = grid.stride(u);
  const std::ptrdiff_t along_v = grid.stride(v);
  const Material* line = grid.origin() + static_cast<std::ptrdiff_t>(layer) * grid.stride(across);
  Material* face = plane.faces.data();
  bool any = false;
  for (std::uint32_t row = 0; row < plane.height; ++row, line += along_v) {
    const Material* voxel = line;
    for (std::uint32_t at = 0; at < plane.width; ++at, voxel += along_u, ++face) {
      const bool drawn = visibility.face_drawn(*voxel, voxel[beside]);
      *face = drawn ? *voxel : kEmpty;
      any |= drawn;
    }
  }
  return any;
}

/// Calls merge(direction, layer) for each plane of a grid with faces, which are in `plane`, by
/// direction and layer.
template <class Merge>
void each_face_plane(const DenseGrid& grid, const VisibilityTable& visibility, FacePlane& plane,
                     Merge&& merge) {
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    const auto direction = static_cast<Direction>(d);
    const std::uint32_t layers =
        grid.extent().sides()[static_cast<std::size_t>(axis_of(direction))];
    for (std::uint32_t layer = 0; layer < layers; ++layer) {
      if (read_faces(grid, visibility, direction, layer, plane)) merge(direction, layer);
    }
  }
}

inline Quad quad_in_plane(Direction direction, std::uint32_t layer, const PlaneRectangle& r) {
  const Axis across = axis_of(direction);
  std::array<std::uint8_t, 3> at{};
  at[static_cast<std::size_t>(across)] = static_cast<std::uint8_t>(layer);
  at[static_cast<std::size_t>(u_axis_of(across))] = static_cast<std::uint8_t>(r.u);
  at[static_cast<std::size_t>(v_axis_of(across))] = static_cast<std::uint8_t>(r.v);
  return face_quad({at[0], at[1], at[2]}, direction, r.material, r.width, r.height);
}

}  // namespace runstone::reference
