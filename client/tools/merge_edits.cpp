#include "client/tools/merge_edits.hpp"

#include <cstdint>
#include <utility>

#include "client/build/drawn_edits.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {
namespace {

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
  VoxelBox box;
  for (const EditDescriptor& edit : edits) box = bounding_box(box, bounding_box(edit));
  const auto untouched = unused_material(edits);
  if (is_too_long(box) || !untouched) return edits;

  ApplyScratch scratch;
  auto clipboard = draw_edits(edits, box, *untouched, scratch).clipboard();
  if (!clipboard) return edits;
  return {EditDescriptor{Paste{box.min, *std::move(clipboard), {}}, mask, kEmpty}};
}

}  // namespace runstone
