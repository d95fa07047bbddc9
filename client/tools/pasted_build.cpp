#include "client/tools/pasted_build.hpp"

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "client/tools/aim.hpp"
#include "client/tools/build_words.hpp"
#include "client/tools/cell_list.hpp"
#include "client/tools/shown_voxels.hpp"

namespace runstone {
namespace {

VoxelPos sum_of(VoxelPos a, VoxelPos b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

}  // namespace

template <class F>
void PastedBuild::for_each_cell(F&& f) const {
  const VoxelPos sides = build_->sides();
  for (VoxelPos cell; cell.z < sides.z; ++cell.z) {
    for (cell.y = 0; cell.y < sides.y; ++cell.y) {
      for (cell.x = 0; cell.x < sides.x; ++cell.x) {
        const auto material = build_->at(cell);
        const bool is_set = material && (*material != kEmpty || empty_ == EmptyCells::pasted);
        if (is_set) f(cell, *material);
      }
    }
  }
}

std::optional<PastedBuild> PastedBuild::of(const ToolAction& made, const ToolClipboard& clipboard,
                                           const Replica& replica) {
  if (made.edits.size() != 1 || !made.pastes.empty() || !clipboard.build) return std::nullopt;
  const auto* const paste = std::get_if<Paste>(&made.edits.front().shape);
  // Another clipboard is that of the copies of a symmetry.
  if (paste == nullptr || paste->clipboard != clipboard.whole) return std::nullopt;
  if (clipboard.build->volume() > kVolumeMax) return std::nullopt;
  PastedBuild out;
  out.build_ = clipboard.build;
  out.at_ = paste->at;
  out.mask_ = made.edits.front().mask;
  out.empty_ = clipboard.empty;
  ShownVoxels shown(replica);
  bool is_known = true;
  out.for_each_cell([&](VoxelPos cell, Material) {
    const VoxelPos at = sum_of(out.at_, cell);
    const auto present = shown.at(at);
    is_known = is_known && present;
    if (present && out.mask_.admits(*present)) out.before_[at] = *present;
  });
  return is_known ? std::optional(std::move(out)) : std::nullopt;
}

ToolEdits PastedBuild::move(Direction direction, const Replica& replica) {
  const VoxelPos to = moved(at_, direction, 1);
  if (!is_in_world(to, build_->sides())) return failure("the build would reach outside the world");
  ShownVoxels shown(replica);
  bool is_known = true;
  std::map<VoxelPos, Material> wanted, before;
  for_each_cell([&](VoxelPos cell, Material material) {
    const VoxelPos at = sum_of(at_, cell);
    const auto replaced = before_.find(at);
    if (replaced != before_.end() && shown.at(at) == material) wanted[at] = replaced->second;
  });
  for_each_cell([&](VoxelPos cell, Material) {
    const VoxelPos at = sum_of(to, cell);
    const auto restored = wanted.find(at);
    const auto present = restored != wanted.end() ? std::optional(restored->second) : shown.at(at);
    is_known = is_known && present;
    if (present && mask_.admits(*present)) before[at] = *present;
  });
  if (!is_known) return failure("the ground is not loaded there");
  for_each_cell([&](VoxelPos cell, Material material) {
    const VoxelPos at = sum_of(to, cell);
    if (before.contains(at)) wanted[at] = material;
  });
  std::vector<Cell> cells;
  for (const auto& [at, material] : wanted) {
    if (shown.at(at) != material) cells.push_back({at, material});
  }
  ToolAction out;
  if (!cells.empty()) {
    auto made = paste_of(std::move(cells), {});
    if (!made) return made;
    out = *std::move(made);
  }
  out.chain = ActionChain::goes_on;
  at_ = to;
  before_ = std::move(before);
  return out;
}

}  // namespace runstone
