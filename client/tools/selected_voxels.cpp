#include "client/tools/selected_voxels.hpp"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include "client/tools/action_source.hpp"
#include "client/tools/aim.hpp"
#include "client/tools/build_words.hpp"
#include "client/tools/typed_pattern.hpp"
#include "common/builds/build_transforms.hpp"
#include "common/patterns/passing_voxels.hpp"

namespace runstone {
namespace {

/// Bounds the rows of boxes that become a set of voxels, and of a set that grows.
constexpr std::uint64_t kSelectedRowsMax = std::uint64_t{1} << 20;

constexpr const char* kTooManySelected =
    "more than 4,000,000 voxels, or too many rows of them: select fewer";

ChunkLookup shown_in(const Replica& replica) {
  return [&replica](ChunkCoord at) { return replica.shown({0, at}); };
}

std::string words_of_build(const Error& error) { return "cannot copy: " + words_of(error); }

/// Returns the build with the materials of a palette, or null if no cell is left.
Result<BuildPtr, std::string> painted(const Build& build,
                                      const std::vector<std::optional<Material>>& palette) {
  if (std::none_of(palette.begin(), palette.end(), [](const auto& m) { return m.has_value(); }))
    return BuildPtr();
  auto out = with_materials(build, palette);
  if (!out) return failure(words_of_build(out.error()));
  return *std::move(out);
}

VoxelPos offset_of(Direction direction, std::int32_t steps) {
  return moved(VoxelPos{}, direction, steps);
}

}  // namespace

Selected Selected::of(VoxelRows rows) {
  Selected out;
  if (rows.empty()) return out;
  // After voxels were removed, the box of the rows may be too wide.
  VoxelBox around;
  for (const auto& [z, y] : rows.places()) {
    const auto& row = *rows.row(y, z);
    around = bounding_box(around, {{row.front().low, y, z}, {row.back().high, y + 1, z + 1}});
  }
  out.boxes = BoxSet(around);
  out.voxel_count = rows.count();
  out.voxels = std::make_shared<const VoxelRows>(std::move(rows));
  return out;
}

Result<VoxelRows, std::string> rows_of(const Selected& selected) {
  if (selected.voxels) return *selected.voxels;
  std::uint64_t rows = 0, voxels = 0;
  for (const VoxelBox& box : selected.boxes.boxes()) {
    const VoxelPos sides = sides_of(box);
    rows += static_cast<std::uint64_t>(sides.y) * static_cast<std::uint64_t>(sides.z);
    // The sum is checked before it is multiplied, because the product could overflow.
    if (rows > kSelectedRowsMax) return failure(kTooManySelected);
    voxels += static_cast<std::uint64_t>(sides.x) * static_cast<std::uint64_t>(sides.y) *
              static_cast<std::uint64_t>(sides.z);
    if (voxels > kSelectedVoxelsMax) return failure(kTooManySelected);
  }
  return rows_of_boxes(selected.boxes.boxes());
}

Result<Selected, std::string> combined(const Selected& now, VoxelRows rows, SelectMode mode) {
  if (mode != SelectMode::fresh) {
    const auto before = rows_of(now);
    if (!before) return failure(before.error());
    rows = mode == SelectMode::add ? united(*before, rows) : without(*before, rows);
  }
  if (rows.count() > kSelectedVoxelsMax) return failure(kTooManySelected);
  return Selected::of(std::move(rows));
}

Result<Selected, std::string> filtered(const Replica& replica, const Selected& now,
                                       const std::string& filter, bool is_kept,
                                       const MaterialTable& materials) {
  if (now.empty()) return failure("nothing is selected");
  if (filter.empty()) return failure("type which voxels, such as: is stone and exposed");
  const ToolText text{"where", "", ToolText::Kind::filter, filter};
  auto typed = typed_pattern(text, materials, {1, middle2_of(now.boxes.around())});
  if (!typed) return failure(typed.error());
  std::uint64_t voxels_max = kSelectedVoxelsMax;
  // The filter may also pass voxels of the box that are not selected, so the bound is higher here.
  if (now.voxels || !is_kept) voxels_max *= 4;
  const auto passing = passing_voxels(now.boxes.boxes(), *std::move(typed->filter), voxels_max,
                                      replica.chunk_edge(), shown_in(replica));
  if (!passing) {
    return failure(passing.error() == FloodFault::missing_chunk
                       ? "a chunk of the selection is not loaded"
                       : kTooManySelected);
  }
  VoxelRows rows;
  if (is_kept && !now.voxels) {
    rows = *passing;
  } else {
    const auto before = rows_of(now);
    if (!before) return failure(before.error());
    rows = is_kept ? common(*before, *passing) : without(*before, *passing);
  }
  if (rows.empty()) return failure("nothing would be left of the selection");
  if (rows.count() > kSelectedVoxelsMax) return failure(kTooManySelected);
  return Selected::of(std::move(rows));
}

Result<Selected, std::string> grown_selection(const Selected& now, Direction side,
                                              std::int32_t steps) {
  const auto rows = rows_of(now);
  if (!rows) return failure(rows.error());
  // Along x a row becomes longer. Along the other axes up to so many rows are added.
  const std::uint64_t copies =
      axis_of(side) == Axis::x || steps < 0 ? 1 : static_cast<std::uint64_t>(steps) + 1;
  if (rows->stretches() > kSelectedVoxelsMax / copies) return failure(kTooManySelected);
  VoxelRows made = steps > 0 ? grown_to(*rows, side, steps) : shrunk_from(*rows, side, -steps);
  if (made.empty()) return failure("nothing would be left of the selection");
  if (made.count() > kSelectedVoxelsMax) return failure(kTooManySelected);
  return Selected::of(std::move(made));
}

ToolEdits refilled(const Replica& replica, const VoxelRows& rows, std::optional<Material> from,
                   Material to) {
  const auto placed = build_of_voxels(rows, replica.chunk_edge(), shown_in(replica), true);
  if (!placed) return failure(words_of_build(placed.error()));
  std::vector<std::optional<Material>> palette;
  for (const Material material : placed->build->palette()) {
    const bool is_changed = material != to && (!from || material == *from);
    palette.push_back(is_changed ? std::optional(to) : std::nullopt);
  }
  auto build = painted(*placed->build, palette);
  if (!build) return failure(build.error());
  if (!*build) return failure("no selected voxel would change");
  return paste_of_build({*std::move(build), placed->at, {}, EmptyCells::pasted, true},
                        replica.edit_limits());
}

ToolEdits moved_voxels(const Replica& replica, const VoxelRows& rows, Direction direction,
                       std::int32_t steps) {
  const VoxelRows target = moved(rows, offset_of(direction, steps));
  // A voxel that moves to a selected place replaces the voxel there, also if it is air. At other
  // places the air of the selection does not move.
  ToolAction out;
  for (const auto& [part, empty] : {std::pair{without(target, rows), EmptyCells::skipped},
                                    std::pair{common(target, rows), EmptyCells::pasted}}) {
    if (part.empty()) continue;
    const bool has_air = empty == EmptyCells::pasted;
    const auto placed = build_of_voxels(moved(part, offset_of(direction, -steps)),
                                        replica.chunk_edge(), shown_in(replica), has_air);
    if (!placed && placed.error().code == ErrorCode::bad_value) continue;  // only air
    if (!placed) return failure(words_of_build(placed.error()));
    const VoxelPos by = offset_of(direction, steps);
    const VoxelPos at{placed->at.x + by.x, placed->at.y + by.y, placed->at.z + by.z};
    if (!is_in_world(at, placed->build->sides()))
      return failure("the selection would reach outside the world");
    out.pastes.push_back({placed->build, at, {}, empty});
  }
  const auto left = build_of_voxels(without(rows, target), replica.chunk_edge(), shown_in(replica));
  if (left) {
    auto air = painted(*left->build,
                       std::vector<std::optional<Material>>(left->build->palette().size(), kEmpty));
    if (!air) return failure(air.error());
    out.cleared = BuildPaste{*std::move(air), left->at, {}, EmptyCells::pasted, true};
  } else if (left.error().code != ErrorCode::bad_value) {
    return failure(words_of_build(left.error()));
  }
  if (out.empty()) return failure("the selection is empty");
  return out;
}

}  // namespace runstone
