// Edit changes: the stretches of a chunk to which one call of apply_stack() gave another material.
// They can be written into a second chunk of the same extent and axis order. Rollback keeps two
// chunks in step that way (common/edits/restore/restore.hpp).
#pragma once
#include <span>

#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/apply/edit_stack.hpp"

namespace runstone {

/// Returns the changes of the last apply_stack() with this scratch, given its result. They ascend
/// and are disjoint. The span is invalid after the next call that uses the scratch.
inline std::span<const Change> changes_of(const ApplyScratch& scratch, const ApplyResult& result) {
  // The list in scratch is not replaced for a stack that misses the chunk.
  if (!result.changed) return {};
  return scratch.changes;
}

/// Gives these stretches their material, whatever the chunk holds there. `changes` may be
/// changes_of() the same scratch. The result is canonical. Cost: O(changes * log(runs between) +
/// runs behind the first one).
void write_changes(RunChunk& chunk, std::span<const Change> changes, ApplyScratch& scratch);

}  // namespace runstone
