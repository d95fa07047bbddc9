#include "client/tools/clipboard_copies.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "client/tools/action_source.hpp"
#include "client/tools/build_words.hpp"
#include "client/tools/turned_materials.hpp"
#include "common/builds/build_transforms.hpp"

namespace runstone {
namespace {

/// Returns the clipboard turned by quarter turns, with its materials.
Result<BuildPtr> turned_clipboard(const ToolInput& input, int quarters) {
  const Orientation orientation = Orientation{}.rotated_about_y(quarters);
  auto made = turned(*input.clipboard.build, orientation);
  if (!made) return made;
  const TurnedMaterials materials =
      turned_materials((*made)->palette(), orientation, input.materials);
  if (!materials.is_changed) return made;
  return with_materials(**made, materials.ids);
}

}  // namespace

Result<void, std::string> check_copied(const ToolClipboard& clipboard) {
  if (!clipboard.build) return failure("nothing was copied");
  const VoxelPos whole = clipboard.build->sides();
  constexpr auto kLongest = static_cast<std::int32_t>(kSideMax);
  if (std::max({whole.x, whole.y, whole.z}) > kLongest)
    return failure("only a clipboard of up to " + std::to_string(kLongest) +
                   " voxels a side can be put down many times");
  return {};
}

ToolEdits copies_of_clipboard(const ToolInput& input, std::span<const CopySpot> spots, Mask mask) {
  std::array<BuildPtr, 4> turns = {input.clipboard.build, nullptr, nullptr, nullptr};
  ToolAction out;
  for (const CopySpot& spot : spots) {
    BuildPtr& build = turns[spot.quarters];
    if (!build) {
      auto made = turned_clipboard(input, spot.quarters);
      if (!made) return failure("cannot turn the clipboard: " + words_of(made.error()));
      build = *std::move(made);
    }
    const VoxelPos sides = build->sides();
    const VoxelPos at{spot.middle.x - sides.x / 2, spot.middle.y, spot.middle.z - sides.z / 2};
    if (!is_in_world(at, sides)) continue;
    ToolAction copy =
        paste_of_build({build, at, mask, EmptyCells::skipped}, input.replica.edit_limits());
    std::move(copy.pastes.begin(), copy.pastes.end(), std::back_inserter(out.pastes));
    std::move(copy.edits.begin(), copy.edits.end(), std::back_inserter(out.edits));
  }
  if (out.empty()) return failure("the copies reach outside the world there");
  return out;
}

}  // namespace runstone
