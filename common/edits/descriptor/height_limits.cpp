#include "common/edits/descriptor/height_limits.hpp"

#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {

bool validate(const HeightLimits& limits) {
  return limits.y_min >= -kWorldLimit && limits.y_min < limits.y_max && limits.y_max <= kWorldLimit;
}

bool within(const EditDescriptor& edit, const HeightLimits& limits) {
  if (!has_voxels(edit)) return true;
  // The bounding box is tight: each kind has a voxel in its lowest and in its highest layer.
  const VoxelBox box = bounding_box(edit);
  return box.min.y >= limits.y_min && box.max.y <= limits.y_max;
}

}  // namespace runstone
