#include "common/mesh/reference/face_layer.hpp"

#include <algorithm>

#include "common/core/assert.hpp"
#include "common/mesh/quad.hpp"

namespace runstone::reference {

bool FaceLayer::read(const DenseGrid& grid, const VisibilityTable& visibility, Direction direction,
                     unsigned layer) {
  const Axis axis = axis_of(direction);
  const Axis u_axis = u_axis_of(axis);
  const Axis v_axis = v_axis_of(axis);
  const auto sides = grid.extent().sides();
  RUNSTONE_ASSERT(layer < sides[static_cast<std::size_t>(axis)]);
  width_ = sides[static_cast<std::size_t>(u_axis)];
  height_ = sides[static_cast<std::size_t>(v_axis)];
  faces_.assign(index(width_, height_) + 1, kEmpty);

  const std::ptrdiff_t across = grid.stride(axis);
  const std::ptrdiff_t beside = is_positive(direction) ? across : -across;
  const std::ptrdiff_t u_stride = grid.stride(u_axis);
  bool any = false;
  for (int v = 0; v < height_; ++v) {
    const Material* voxel =
        grid.origin() + static_cast<std::ptrdiff_t>(layer) * across + v * grid.stride(v_axis);
    Material* face = faces_.data() + index(0, v);
    for (int u = 0; u < width_; ++u, voxel += u_stride, ++face) {
      if (!visibility.face_drawn(*voxel, voxel[beside])) continue;
      *face = *voxel;
      any = true;
    }
  }
  return any;
}

}  // namespace runstone::reference
