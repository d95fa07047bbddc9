#include "client/tools/merge_edits.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/runs/cut.hpp"

namespace runstone {
namespace {

VoxelBox box_around(const std::vector<EditDescriptor>& edits) {
  VoxelBox box = bounding_box(edits.front());
  for (const EditDescriptor& edit : edits) {
    const VoxelBox b = bounding_box(edit);
    box.min = {std::min(box.min.x, b.min.x), std::min(box.min.y, b.min.y),
               std::min(box.min.z, b.min.z)};
    box.max = {std::max(box.max.x, b.max.x), std::max(box.max.y, b.max.y),
               std::max(box.max.z, b.max.z)};
  }
  return box;
}

/// Returns a material that none of the edits writes. It marks the voxels that no edit touches.
std::optional<Material> unused_material(const std::vector<EditDescriptor>& edits) {
  Material most = kEmpty;
  for (const EditDescriptor& edit : edits) {
    if (const auto* paste = std::get_if<Paste>(&edit.shape)) {
      most = std::max(most, paste->clipboard->palette().back());
    }
    most = std::max(most, edit.material);
  }
  if (most + std::size_t{1} >= kMaterialCountMax) return std::nullopt;
  return static_cast<Material>(most + 1);
}

bool is_too_long(const VoxelBox& box) {
  const auto side_max = std::int64_t{kSideMax};
  const auto side = [](std::int32_t low, std::int32_t high) { return std::int64_t{high} - low; };
  return side(box.min.x, box.max.x) > side_max || side(box.min.y, box.max.y) > side_max ||
         side(box.min.z, box.max.z) > side_max;
}

}  // namespace

std::vector<EditDescriptor> merge_edits(std::vector<EditDescriptor> edits) {
  if (edits.size() < 2) return edits;
  const Mask mask = edits.front().mask;
  for (const EditDescriptor& edit : edits) {
    if (edit.mask != mask) return edits;
  }
  const VoxelBox box = box_around(edits);
  const auto untouched = unused_material(edits);
  if (is_too_long(box) || !untouched) return edits;

  // The edits are applied to a chunk of the unused material. A chunk has sides of 8 voxels at
  // least, so the part inside the box is cut out of it.
  const auto side = [](std::int32_t low, std::int32_t high) {
    return static_cast<std::uint8_t>(high - low);
  };
  const Extent extent{side(box.min.x, box.max.x), side(box.min.y, box.max.y),
                      side(box.min.z, box.max.z)};
  const auto at_least_8 = [](std::uint8_t s) {
    return std::max(s, static_cast<std::uint8_t>(kSideMin));
  };
  RunChunk drawn =
      uniform_chunk({at_least_8(extent.x), at_least_8(extent.y), at_least_8(extent.z)}, *untouched);
  std::vector<EditDescriptor> plain = edits;
  for (EditDescriptor& edit : plain) edit.mask = {};
  Digest digest = digest_of(drawn);
  ApplyScratch scratch;
  apply_stack(drawn, digest, box.min, plain, scratch);
  const RunChunk cells = cut(drawn, {0, 0, 0}, extent);
  ClipboardBuilder out(extent, cells.order);
  for (std::size_t i = 0; i < cells.runs.size(); ++i) {
    const Run run = cells.runs[i];
    const bool is_touched = run.material != *untouched;
    out.append(run.end - out.filled(),
               is_touched ? std::optional<Material>(run.material) : std::nullopt);
  }
  auto clipboard = out.finish();
  if (!clipboard) return edits;
  return {EditDescriptor{Paste{box.min, *std::move(clipboard), {}}, mask, kEmpty}};
}

}  // namespace runstone
