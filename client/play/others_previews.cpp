#include "client/play/others_previews.hpp"

#include <algorithm>
#include <utility>

#include "client/render/author_rgb.hpp"
#include "client/tools/ground_stroke.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {

void OthersPreviews::set_materials(const MaterialTable& materials, MeshMaterialsPtr meshed) {
  materials_ = materials;
  meshed_ = std::move(meshed);
  for (auto& [author, shown] : previews_) {
    shown.edits.set_materials(meshed_);
    shown.builds.set_materials(meshed_);
    shown.is_plan_due = shown.stroke.has_value();
  }
}

void OthersPreviews::take(Shown& shown, const SharedPreviews::Shared& shared) {
  if (shared.stroke) {
    if (shown.stroke == shared.stroke) return;
    shown.stroke = shared.stroke;
    shown.is_plan_due = true;  // what was shown before stays until then
    return;
  }
  shown.stroke.reset();
  shown.is_plan_due = false;
  shown.edits.set(shared.edits);
  shown.builds.set({});
}

void OthersPreviews::plan_next(const Replica& replica,
                               const std::map<AuthorId, SharedPreviews::Shared>& shared) {
  const auto is_due = [](const auto& entry) { return entry.second.is_plan_due; };
  auto next = std::find_if(previews_.upper_bound(planned_), previews_.end(), is_due);
  if (next == previews_.end()) next = std::find_if(previews_.begin(), previews_.end(), is_due);
  if (next == previews_.end()) return;
  planned_ = next->first;
  Shown& shown = next->second;
  shown.is_plan_due = false;
  auto made = edits_of_stroke(*shown.stroke, replica, materials_, shown.upright, kPatternWorkMax);
  if (!made) {
    shown.edits.set(shared.at(planned_).edits);
    return shown.builds.set({});
  }
  std::vector<ShownBuild> builds;
  for (const BuildPaste& paste : made->pastes)
    builds.push_back({paste.build, paste.at, false, paste.is_difference});
  shown.edits.set(std::move(made->edits));
  shown.builds.set(std::move(builds));
}

bool OthersPreviews::step(const Replica& replica,
                          const std::map<AuthorId, SharedPreviews::Shared>& shared) {
  bool has_changed = std::erase_if(previews_, [&](const auto& entry) {
                       return !shared.contains(entry.first);
                     }) != 0;
  for (const auto& [author, other] : shared) {
    if (previews_.size() >= kShownMax && !previews_.contains(author)) continue;
    const auto [it, is_new] = previews_.try_emplace(author);
    if (is_new) {
      it->second.edits.set_materials(meshed_);
      it->second.builds.set_materials(meshed_);
    }
    take(it->second, other);
    // The ground changed below a stroke that is shown.
    if (it->second.stroke && it->second.edits.is_complete() && !it->second.edits.edits().empty() &&
        it->second.edits.is_outdated(replica))
      it->second.is_plan_due = true;
  }
  plan_next(replica, shared);
  std::size_t left = kChunksPerStep;
  for (auto& [author, shown] : previews_) {
    // A preview that is complete costs a look at its chunks only.
    if (left == 0) break;
    const std::size_t part = shown.is_complete() ? kChunksPerStep : left;
    const bool was_complete = shown.is_complete() && !shown.edits.is_outdated(replica);
    has_changed = shown.edits.step(replica, part) || has_changed;
    has_changed = shown.builds.step(std::max<std::size_t>(part / 8, 1)) || has_changed;
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
  for (const auto& [author, shown] : previews_) {
    for (const auto* const ghosts : {&shown.edits.ghosts(), &shown.builds.ghosts()}) {
      for (GhostChunk ghost : *ghosts) {
        ghost.tint = author_rgb(author);
        out.push_back(std::move(ghost));
      }
    }
  }
}

void OthersPreviews::append_outlines(std::vector<Marker>& out) const {
  constexpr double kGap = 0.03;  // so that the outline lies before the faces of the ghost
  for (const auto& [author, shown] : previews_) {
    const auto [r, g, b] = author_rgb(author);
    const auto add = [&](const VoxelBox& box) {
      if (box.empty()) return;
      out.push_back({box.min.x - kGap, box.min.y - kGap, box.min.z - kGap,
                     box.max.x - box.min.x + 2 * kGap, box.max.y - box.min.y + 2 * kGap,
                     box.max.z - box.min.z + 2 * kGap, r, g, b});
    };
    for (const EditDescriptor& edit : shown.edits.edits()) add(bounding_box(edit));
    for (const ShownBuild& build : shown.builds.builds()) {
      const VoxelPos sides = build.build->sides();
      add({build.at, {build.at.x + sides.x, build.at.y + sides.y, build.at.z + sides.z}});
    }
  }
}

}  // namespace runstone
