#include "common/edits/restore/voxel_restore.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "common/core/assert.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {
namespace {

/// Returns the material of a voxel after an edit. Requires that the bounding box of the edit holds
/// the voxel.
Material material_after(const EditDescriptor& edit, VoxelPos at, Material present,
                        ApplyScratch& scratch) {
  if (std::holds_alternative<Paste>(edit.shape)) {
    RunChunk voxel = uniform_chunk({1, 1, 1}, present);
    Digest unused;
    apply_stack(voxel, unused, at, {&edit, 1}, scratch);
    return voxel.runs.material(0);
  }
  const bool is_box =
      std::holds_alternative<SetVoxel>(edit.shape) || std::holds_alternative<FillBox>(edit.shape);
  const bool is_covered = is_box || touches(edit, {at, {at.x + 1, at.y + 1, at.z + 1}});
  return is_covered && edit.mask.admits(present) ? edit.material : present;
}

}  // namespace

VoxelRestore::VoxelRestore(std::vector<VoxelPos> voxels, std::vector<Material> before)
    : voxels_(std::move(voxels)), now_(std::move(before)), restored_(now_) {
  RUNSTONE_ASSERT(voxels_.size() == now_.size());
}

template <class Write>
void VoxelRestore::apply(const EditDescriptor& edit, ApplyScratch& scratch, const Write& write) {
  if (!has_voxels(edit)) return;
  const VoxelBox box = bounding_box(edit);
  auto at = std::lower_bound(voxels_.begin(), voxels_.end(), box.min);
  for (; at != voxels_.end() && at->x < box.max.x; ++at) {
    if (!box.contains(*at)) {
      if (std::holds_alternative<SetVoxel>(edit.shape)) return;
      continue;
    }
    const auto i = static_cast<std::size_t>(at - voxels_.begin());
    const Material after = material_after(edit, *at, now_[i], scratch);
    if (after == now_[i]) continue;
    now_[i] = after;
    write(i);
  }
}

void VoxelRestore::add(const EditDescriptor& edit, bool is_selected, ApplyScratch& scratch) {
  apply(edit, scratch, [&](std::size_t i) {
    if (!is_selected) restored_[i] = now_[i];
  });
}

void VoxelRestore::add_return(const EditDescriptor& edit, const Point& before,
                              ApplyScratch& scratch) {
  apply(edit, scratch, [&](std::size_t i) {
    restored_[i] = before.now[i] == now_[i] ? before.restored[i] : now_[i];
  });
}

std::uint64_t VoxelRestore::differences() const {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < now_.size(); ++i) count += now_[i] != restored_[i] ? 1 : 0;
  return count;
}

}  // namespace runstone
