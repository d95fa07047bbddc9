#include "client/play/others_previews.hpp"

#include <utility>

#include "client/render/author_rgb.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {

void OthersPreviews::set_materials(MeshMaterialsPtr materials) {
  materials_ = std::move(materials);
  for (auto& [author, preview] : previews_) preview.set_materials(materials_);
}

bool OthersPreviews::step(const Replica& replica,
                          const std::map<AuthorId, SharedPreviews::Shared>& shared) {
  bool has_changed = std::erase_if(previews_, [&](const auto& entry) {
                       return !shared.contains(entry.first);
                     }) != 0;
  for (const auto& [author, other] : shared) {
    if (previews_.size() >= kShownMax && !previews_.contains(author)) continue;
    const auto [it, is_new] = previews_.try_emplace(author);
    if (is_new) it->second.set_materials(materials_);
    it->second.set(other.edits);
  }
  std::size_t left = kChunksPerStep;
  for (auto& [author, preview] : previews_) {
    // A preview that is complete costs a look at its chunks only.
    if (left == 0) break;
    const std::size_t part = preview.is_complete() ? kChunksPerStep : left;
    const bool was_complete = preview.is_complete() && !preview.is_outdated(replica);
    has_changed = preview.step(replica, part) || has_changed;
    if (!was_complete) left = 0;
  }
  return has_changed;
}

bool OthersPreviews::clear() {
  const bool had_any = !previews_.empty();
  previews_.clear();
  return had_any;
}

void OthersPreviews::append_ghosts(std::vector<GhostChunk>& out) const {
  for (const auto& [author, preview] : previews_) {
    for (GhostChunk ghost : preview.ghosts()) {
      ghost.tint = author_rgb(author);
      out.push_back(std::move(ghost));
    }
  }
}

void OthersPreviews::append_outlines(std::vector<Marker>& out) const {
  constexpr double kGap = 0.03;  // so that the outline lies before the faces of the ghost
  for (const auto& [author, preview] : previews_) {
    const auto [r, g, b] = author_rgb(author);
    for (const EditDescriptor& edit : preview.edits()) {
      const VoxelBox box = bounding_box(edit);
      if (box.empty()) continue;
      out.push_back({box.min.x - kGap, box.min.y - kGap, box.min.z - kGap,
                     box.max.x - box.min.x + 2 * kGap, box.max.y - box.min.y + 2 * kGap,
                     box.max.z - box.min.z + 2 * kGap, r, g, b});
    }
  }
}

}  // namespace runstone
