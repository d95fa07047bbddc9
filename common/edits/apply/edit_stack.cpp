#include "common/edits/apply/edit_stack.hpp"

#include <algorithm>
#include <variant>

#include "common/core/assert.hpp"
#include "common/edits/apply/change_tally.hpp"
#include "common/edits/apply/edit_changes.hpp"
#include "common/edits/apply/edit_stack_strategies.hpp"
#include "common/edits/apply/edit_sweep.hpp"
#include "common/edits/apply/layer_painter.hpp"
#include "common/edits/descriptor/ordered_shape.hpp"

namespace runstone {
namespace {

// Fills the stack with all parts of the edits that may touch the chunk. Returns the number of these
// edits.
std::size_t stack_up(const RunChunk& chunk, VoxelPos origin, std::span<const EditDescriptor> edits,
                     std::vector<StackPart>& stack) {
  stack.clear();
  std::size_t count = 0;
  for (const EditDescriptor& edit : edits) {
    RUNSTONE_DASSERT(validate(edit).has_value());
    const std::size_t before = stack.size();
    for_each_part(edit, origin, chunk.extent, chunk.order,
                  [&](const OrderedShape& shape, Material material) {
                    stack.push_back({shape, edit.mask, material});
                  });
    count += stack.size() != before ? 1 : 0;
  }
  return count;
}

// For a layer that edits cover completely, the sweep visits only runs, even if the layer has many
// voxels.
ChangeSearch cheaper_search(std::size_t edits, const RunChunk& chunk,
                            std::span<const StackPart> stack) {
  if (edits == 1) return ChangeSearch::walk;
  const OrderedExtent extent = ordered(chunk.extent, chunk.order);
  const bool whole = std::any_of(stack.begin(), stack.end(), [&](const StackPart& part) {
    return part.shape.covers_layers(extent);
  });
  return whole ? ChangeSearch::sweep : ChangeSearch::paint;
}

void search_stack(ChangeSearch search, const RunChunk& chunk, ApplyScratch& scratch,
                  ChangeTally& tally) {
  switch (search) {
    case ChangeSearch::walk:
      return walk_changes(chunk, scratch, tally);
    case ChangeSearch::sweep:
      return sweep_changes(chunk, scratch, tally);
    case ChangeSearch::paint:
      return paint_changes(chunk, scratch, tally);
  }
}

// Passes all changes of the edits to `tally`.
void search_edits(const RunChunk& chunk, VoxelPos origin, std::span<const EditDescriptor> edits,
                  ApplyScratch& scratch, ChangeTally& tally) {
  if (edits.size() == 1 && std::holds_alternative<Paste>(edits.front().shape))
    return walk_paste(chunk, origin, edits.front(), scratch, tally);
  const std::size_t count = stack_up(chunk, origin, edits, scratch.stack);
  if (count != 0) search_stack(cheaper_search(count, chunk, scratch.stack), chunk, scratch, tally);
}

// Fills the result, and the patch in scratch.runs, with what search(tally) finds. The chunk does
// not change.
template <class Search>
void plan_changes(const RunChunk& chunk, Digest& digest, ApplyScratch& scratch, ApplyResult& result,
                  Search&& search) {
  scratch.changes.clear();
  scratch.runs.clear();
  ChangeTally tally(chunk, scratch.changes, scratch.factors);
  search(tally);
  tally.finish();
  if (scratch.changes.empty()) return;
  digest = digest + tally.digest_difference();
  // It is set before the chunk changes: if memory runs out while it is false, the chunk is as it was.
  result.changed = true;
  result.dirty = tally.dirty();
  result.voxels_changed = tally.voxels();
  plan_patch(chunk, scratch.changes, result.areas, scratch.runs);
}

void reset(ApplyResult& result) {
  result.changed = false;
  result.dirty = {};
  result.areas.clear();
  result.voxels_changed = 0;
}

}  // namespace

void apply_stack(RunChunk& chunk, Digest& digest, VoxelPos origin,
                 std::span<const EditDescriptor> edits, ApplyScratch& scratch,
                 ApplyResult& result) {
  reset(result);
  plan_changes(chunk, digest, scratch, result,
               [&](ChangeTally& tally) { search_edits(chunk, origin, edits, scratch, tally); });
  if (!result.changed) return;
  write_patch(chunk, result.areas, scratch.runs, cheaper_write(chunk, result.areas), scratch.whole);
}

ApplyResult apply_stack(RunChunk& chunk, Digest& digest, VoxelPos origin,
                        std::span<const EditDescriptor> edits, ApplyScratch& scratch) {
  ApplyResult result;
  apply_stack(chunk, digest, origin, edits, scratch, result);
  return result;
}

std::span<const Change> find_changes(const RunChunk& chunk, VoxelPos origin,
                                     std::span<const EditDescriptor> edits, ApplyScratch& scratch) {
  scratch.changes.clear();
  ChangeTally tally(chunk, scratch.changes, scratch.factors, ChangeTally::Want::changes);
  search_edits(chunk, origin, edits, scratch, tally);
  tally.finish();
  return scratch.changes;
}

ApplyResult apply_stack_by(ApplyStrategy strategy, RunChunk& chunk, Digest& digest, VoxelPos origin,
                           std::span<const EditDescriptor> edits, ApplyScratch& scratch) {
  ApplyResult result;
  const std::size_t count = stack_up(chunk, origin, edits, scratch.stack);
  if (count == 0) return result;
  RUNSTONE_ASSERT(count == 1 || strategy.search != ChangeSearch::walk);
  plan_changes(chunk, digest, scratch, result,
               [&](ChangeTally& tally) { search_stack(strategy.search, chunk, scratch, tally); });
  write_patch(chunk, result.areas, scratch.runs, strategy.write, scratch.whole);
  return result;
}

}  // namespace runstone
