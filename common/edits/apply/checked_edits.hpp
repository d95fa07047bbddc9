// Checked edits of a chunk, for a host whose chunks and edits come from data: what apply_stack()
// requires is a result here.
#pragma once
#include <span>

#include "common/core/result.hpp"
#include "common/edits/apply/edit_stack.hpp"

namespace runstone {

/// Applies edits as apply_stack() does. Fails, and leaves chunk and digest as they were, if
///   - the chunk is not valid, with the error of validate();
///   - the chunk would reach out of the world, with bad_value;
///   - an edit is not valid, with the error of validate(). The offset is the index of the edit.
/// Requires a digest of the chunk: with another one, the result differs from the digest of the new
/// chunk in the same way. Cost: that of apply_stack(), and O(runs of the chunk).
Result<ApplyResult> try_apply_stack(RunChunk& chunk, Digest& digest, VoxelPos origin,
                                    std::span<const EditDescriptor> edits, ApplyScratch& scratch);

}  // namespace runstone
