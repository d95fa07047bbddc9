#include "client/bots/placed_voxels.hpp"

#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {

void PlacedVoxels::add(const EditDescriptor& edit) {
  const auto* voxel = std::get_if<SetVoxel>(&edit.shape);
  if (voxel != nullptr && edit.mask.kind == MaskKind::everything) {
    set_[voxel->at] = edit.material;
    return;
  }
  forget(edit);
}

void PlacedVoxels::forget(const EditDescriptor& edit) {
  const VoxelBox box = bounding_box(edit);
  std::erase_if(set_, [&box](const auto& entry) { return box.contains(entry.first); });
}

PlacedVoxels::Standing PlacedVoxels::compare(const Replica& replica) const {
  Standing standing;
  standing.held = set_.size();
  for (const auto& [at, material] : set_) {
    const auto shown = replica.shown_at(at);
    ++(!shown ? standing.unseen : *shown == material ? standing.intact : standing.changed);
  }
  return standing;
}

}  // namespace runstone
