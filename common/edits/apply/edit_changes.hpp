// Edit changes: the stretches of a chunk to which one call of apply_stack() gave another material.
// They can be written into a second chunk of the same extent and axis order. Rollback keeps two
// chunks in step that way (common/edits/restore/restore.hpp).
#pragma once
#include <span>

#include "common/core/coords.hpp"
#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Returns the changes of the last apply_stack() with this scratch, given its result. They ascend
/// and are disjoint. The span is invalid after the next call that uses the scratch.
inline std::span<const Change> changes_of(const ApplyScratch& scratch, const ApplyResult& result) {
  if (!result.changed) return {};
  return scratch.changes;
}

/// Returns the changes that apply_stack() would make, and makes none: no digest is
/// computed and no run is written. They ascend and are disjoint. The span is invalid after the next
/// call that uses the scratch. Requires what apply_stack() does. Cost: O(rows of the edits + runs
/// crossed + log runs).
std::span<const Change> find_changes(const RunChunk& chunk, VoxelPos origin,
                                     std::span<const EditDescriptor> edits, ApplyScratch& scratch);

/// Gives these stretches their material, whatever the chunk holds there. `changes` may be
/// changes_of() the same scratch. The result is canonical. Cost: O(changes * log(runs between) +
/// runs behind the first one).
void write_changes(RunChunk& chunk, std::span<const Change> changes, ApplyScratch& scratch);

}  // namespace runstone
