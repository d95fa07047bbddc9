#include "protocol/rules/edit_check.hpp"

#include <algorithm>
#include <limits>

#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {

std::optional<RejectReason> check_edit(const EditDescriptor& edit, const EditLimits& limits) {
  if (!validate(edit) || !has_voxels(edit)) return RejectReason::bad_edit;
  if (material_max(edit) >= limits.material_count) return RejectReason::unknown_material;
  if (!within(edit, limits.heights)) return RejectReason::outside_world;
  if (touched_chunks_bound(edit, limits.chunk_edge) > limits.touched_chunks_max)
    return RejectReason::too_large;
  if (counted_voxels(edit) > limits.volume_max) return RejectReason::too_large;
  return std::nullopt;
}

std::optional<RejectReason> check_server_edit(const EditDescriptor& edit,
                                              const EditLimits& limits) {
  EditLimits wider = limits;
  wider.heights = {};
  wider.volume_max = std::numeric_limits<std::uint64_t>::max();
  if (!has_voxels(edit) && validate(edit)) return std::nullopt;
  return check_edit(edit, wider);
}

bool within_reach(const EditDescriptor& edit, const WorldPos& from, double reach) {
  const VoxelBox box = bounding_box(edit);
  // Along one axis, to the centre of the farthest voxel. `end` is not included.
  const auto farthest = [](double at, std::int32_t first, std::int32_t end) {
    return std::max(at - (first + 0.5), (end - 0.5) - at);
  };
  const double dx = farthest(from.x, box.min.x, box.max.x);
  const double dy = farthest(from.y, box.min.y, box.max.y);
  const double dz = farthest(from.z, box.min.z, box.max.z);
  return dx * dx + dy * dy + dz * dz <= reach * reach;
}

}  // namespace runstone
