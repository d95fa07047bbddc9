#include "client/tools/aim.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/formats/facing_words.hpp"

namespace runstone {

VoxelPos voxel_on_ray(const Aim& aim, double distance) {
  const auto along = [distance](double from, double slope) {
    return static_cast<std::int32_t>(std::floor(from + slope * distance));
  };
  return {along(aim.eye.x, aim.look.x), along(aim.eye.y, aim.look.y), along(aim.eye.z, aim.look.z)};
}

double distance_to(const Aim& aim, VoxelPos voxel) {
  const double dx = voxel.x + 0.5 - aim.eye.x, dy = voxel.y + 0.5 - aim.eye.y,
               dz = voxel.z + 0.5 - aim.eye.z;
  return std::sqrt(dx * dx + dy * dy + dz * dz);
}

std::int32_t stroke_step(VoxelPos from, VoxelPos to) {
  return std::max({std::abs(to.x - from.x), std::abs(to.y - from.y), std::abs(to.z - from.z)});
}

Direction horizontal_look(const LookDirection& look) {
  if (std::abs(look.x) > std::abs(look.z)) return look.x < 0 ? Direction::neg_x : Direction::pos_x;
  return look.z < 0 ? Direction::neg_z : Direction::pos_z;
}

Result<void, std::string> check_steps(std::span<const VoxelPos> places) {
  for (std::size_t i = 1; i < places.size(); ++i) {
    if (stroke_step(places[i - 1], places[i]) > kStrokeStepMax)
      return failure("two places are more than " + std::to_string(kStrokeStepMax) +
                     " voxels apart");
  }
  return {};
}

VoxelBox box_between(VoxelPos a, VoxelPos b) {
  return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
          {std::max(a.x, b.x) + 1, std::max(a.y, b.y) + 1, std::max(a.z, b.z) + 1}};
}

VoxelPos moved(VoxelPos voxel, Direction direction, std::int32_t steps) {
  const std::int32_t step = is_positive(direction) ? steps : -steps;
  switch (axis_of(direction)) {
    case Axis::x:
      voxel.x += step;
      break;
    case Axis::y:
      voxel.y += step;
      break;
    case Axis::z:
      voxel.z += step;
      break;
  }
  return voxel;
}

Direction horizontal_right(const LookDirection& look) { return right_of(horizontal_look(look)); }

VoxelPos sides_of(const VoxelBox& box) {
  return {box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
}

VoxelBox moved(const VoxelBox& box, Direction direction, std::int32_t steps) {
  return {moved(box.min, direction, steps), moved(box.max, direction, steps)};
}

}  // namespace runstone
