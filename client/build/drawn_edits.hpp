// DrawnEdits: what edits write into the cells of a box, whatever is there, as the runs of a chunk.
#pragma once
#include <memory>
#include <optional>
#include <span>

#include "common/core/result.hpp"
#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/clipboard/clipboard.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Returns a material that none of the edits writes, or nullopt if there is none. Requires valid
/// edits. Cost: O(materials log materials).
std::optional<Material> unused_material(std::span<const EditDescriptor> edits);

struct DrawnEdits {
  RunChunk cells;
  Material untouched = kEmpty;  // of cells that no edit touches

  /// Returns true if all cells have one material, or none is touched.
  bool is_uniform() const { return cells.is_uniform(); }
  /// Returns the cells as a clipboard. Fails as ClipboardBuilder::finish() does.
  Result<std::shared_ptr<const Clipboard>> clipboard() const;
};

/// Draws edits into a box, the last one on top. Their masks are ignored. `untouched` is a material of
/// unused_material(). Requires valid edits, and a box whose sides are 1 .. kSideMax. Cost: that of
/// apply_stack().
DrawnEdits draw_edits(std::span<const EditDescriptor> edits, const VoxelBox& box,
                      Material untouched, ApplyScratch& scratch);

}  // namespace runstone
