// Edit changes: the stretches of a chunk that one call of apply_stack() gave another material, to be written
// into a second chunk of the same extent and axis order. Rollback follows two chunks that way
// (common/edits/restore/restore.hpp).
#pragma once
#include <span>

#include "common/edits/apply/apply_scratch.hpp"
#include "common/edits/apply/edit_stack.hpp"

namespace runstone {

/// What the last apply_stack() with this scratch changed, given its result: ascending, disjoint. Dies with
/// the next call that takes the scratch.
inline std::span<const Change> changes_of(const ApplyScratch& scratch, const ApplyResult& result) {
  if (!result.changed) return {};  // the list is not made anew for a stack that misses the chunk
  return scratch.changes;
}

/// Gives these stretches their material, whatever the chunk holds there. `changes` may be changes_of() the
/// same scratch. The result is canonical. O(changes * log(runs between) + runs behind the first one).
void write_changes(RunChunk& chunk, std::span<const Change> changes, ApplyScratch& scratch);

}  // namespace runstone
