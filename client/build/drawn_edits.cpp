#include "client/build/drawn_edits.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/runs/cut.hpp"

namespace runstone {

std::optional<Material> unused_material(std::span<const EditDescriptor> edits) {
  std::vector<Material> used;
  for (const EditDescriptor& edit : edits) {
    if (const auto* paste = std::get_if<Paste>(&edit.shape)) {
      const auto& palette = paste->clipboard->palette();
      used.insert(used.end(), palette.begin(), palette.end());
    } else {
      used.push_back(edit.material);
    }
  }
  std::sort(used.begin(), used.end());
  std::size_t unused = 0;
  for (const Material material : used) {
    if (material > unused) break;
    unused = material + std::size_t{1};
  }
  if (unused >= kMaterialCountMax) return std::nullopt;
  return static_cast<Material>(unused);
}

Result<std::shared_ptr<const Clipboard>> DrawnEdits::clipboard() const {
  ClipboardBuilder out(cells.extent, cells.order);
  for (std::size_t i = 0; i < cells.runs.size(); ++i) {
    const Run run = cells.runs[i];
    out.append(run.end - out.filled(),
               run.material == untouched ? std::nullopt : std::optional<Material>(run.material));
  }
  return out.finish();
}

DrawnEdits draw_edits(std::span<const EditDescriptor> edits, const VoxelBox& box,
                      Material untouched, ApplyScratch& scratch) {
  const auto side = [](std::int32_t low, std::int32_t high) {
    return static_cast<std::uint8_t>(high - low);
  };
  const Extent extent{side(box.min.x, box.max.x), side(box.min.y, box.max.y),
                      side(box.min.z, box.max.z)};
  // A chunk has sides of kSideMin voxels at least, so the part inside the box is cut out of it.
  const auto at_least = [](std::uint8_t s) {
    return std::max(s, static_cast<std::uint8_t>(kSideMin));
  };
  RunChunk chunk =
      uniform_chunk({at_least(extent.x), at_least(extent.y), at_least(extent.z)}, untouched);
  std::vector<EditDescriptor> plain(edits.begin(), edits.end());
  for (EditDescriptor& edit : plain) edit.mask = {};
  Digest digest = digest_of(chunk);
  apply_stack(chunk, digest, box.min, plain, scratch);
  return {cut(chunk, {0, 0, 0}, extent), untouched};
}

}  // namespace runstone
