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

std::string refusal_words(RejectReason reason, const EditDescriptor& edit,
                          const EditLimits& limits) {
  constexpr const char* kCut = ": fill, replace or paste a selection, which is sent in parts";
  switch (reason) {
    case RejectReason::too_large:
      if (counted_voxels(edit) > limits.volume_max) {
        return "the edit has " + std::to_string(counted_voxels(edit)) +
               " voxels, and one edit may have " + std::to_string(limits.volume_max) + kCut;
      }
      return "the edit touches " + std::to_string(touched_chunks_bound(edit, limits.chunk_edge)) +
             " chunks, and one edit may touch " + std::to_string(limits.touched_chunks_max) + kCut;
    case RejectReason::outside_world: {
      const VoxelBox box = bounding_box(edit);
      return "the edit reaches from y = " + std::to_string(box.min.y) + " to " +
             std::to_string(box.max.y - 1) + ", and the world takes edits from " +
             std::to_string(limits.heights.y_min) + " to " +
             std::to_string(limits.heights.y_max - 1);
    }
    case RejectReason::unknown_material:
      return "the edit uses material " + std::to_string(material_max(edit)) +
             ", and the world has those below " + std::to_string(limits.material_count);
    default:
      return {};
  }
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
