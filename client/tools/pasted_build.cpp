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
VoxelPos difference_of(VoxelPos a, VoxelPos b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

}  // namespace

template <class F>
void PastedBuild::for_each_cell(F&& f) const {
  std::size_t number = 0;
  for (VoxelPos cell; cell.z < sides_.z; ++cell.z) {
    for (cell.y = 0; cell.y < sides_.y; ++cell.y) {
      for (cell.x = 0; cell.x < sides_.x; ++cell.x) f(cell, number++);
    }
  }
}

std::optional<std::size_t> PastedBuild::number_of(VoxelPos cell) const {
  const VoxelBox box{{0, 0, 0}, sides_};
  if (!box.contains(cell)) return std::nullopt;
  return static_cast<std::size_t>(cell.x + sides_.x * (cell.y + sides_.y * cell.z));
}

std::optional<PastedBuild> PastedBuild::of(const ToolAction& made, const ToolClipboard& clipboard,
                                           const Replica& replica) {
  if (made.edits.size() != 1 || !made.pastes.empty() || !clipboard.build) return std::nullopt;
  const auto* const paste = std::get_if<Paste>(&made.edits.front().shape);
  // Another clipboard is that of the copies of a symmetry.
  if (paste == nullptr || paste->clipboard != clipboard.whole) return std::nullopt;
  if (clipboard.build->volume() > kVolumeMax) return std::nullopt;
  PastedBuild out;
  out.sides_ = clipboard.build->sides();
  out.at_ = paste->at;
  out.mask_ = made.edits.front().mask;
  out.cells_.assign(clipboard.build->volume(), kNone);
  out.before_ = out.cells_;
  ShownVoxels shown(replica);
  bool is_known = true;
  out.for_each_cell([&](VoxelPos cell, std::size_t number) {
    const auto material = clipboard.build->at(cell);
    if (!material || (*material == kEmpty && clipboard.empty != EmptyCells::pasted)) return;
    out.cells_[number] = *material;
    const auto present = shown.at(sum_of(out.at_, cell));
    is_known = is_known && present;
    if (present && out.mask_.admits(*present)) out.before_[number] = *present;
  });
  return is_known ? std::optional(std::move(out)) : std::nullopt;
}

ToolEdits PastedBuild::move(Direction direction, const Replica& replica) {
  const VoxelPos to = moved(at_, direction, 1);
  if (!is_in_world(to, sides_)) return failure("the build would reach outside the world");
  ShownVoxels shown(replica);
  // The voxels that become free get back the materials that they had before the paste, unless
  // somebody has changed them in the meantime.
  std::vector<Slot> restored(cells_.size(), kNone);
  for_each_cell([&](VoxelPos cell, std::size_t number) {
    if (before_[number] == kNone) return;
    const auto present = shown.at(sum_of(at_, cell));
    if (present && *present == cells_[number]) restored[number] = before_[number];
  });
  bool is_known = true;
  std::vector<Slot> before(cells_.size(), kNone);
  std::vector<Cell> changed;
  for_each_cell([&](VoxelPos cell, std::size_t number) {
    if (cells_[number] == kNone) return;
    const VoxelPos at = sum_of(to, cell);
    const auto present = shown.at(at);
    is_known = is_known && present;
    if (!present) return;
    const auto left = number_of(difference_of(at, at_));
    const bool is_left = left && restored[*left] != kNone;
    const auto ground = is_left ? static_cast<Material>(restored[*left]) : *present;
    if (!mask_.admits(ground)) return;
    before[number] = ground;
    if (is_left) restored[*left] = kNone;  // the build covers it again
    const auto material = static_cast<Material>(cells_[number]);
    if (*present != material) changed.push_back({at, material});
  });
  if (!is_known) return failure("the ground is not loaded there");
  for_each_cell([&](VoxelPos cell, std::size_t number) {
    if (restored[number] == kNone || restored[number] == cells_[number]) return;
    changed.push_back({sum_of(at_, cell), static_cast<Material>(restored[number])});
  });
  ToolAction out;
  if (!changed.empty()) {
    auto made = paste_of(std::move(changed), {});
    if (!made) return made;
    out = *std::move(made);
  }
  out.chain = ActionChain::goes_on;
  at_ = to;
  before_ = std::move(before);
  return out;
}

}  // namespace runstone
