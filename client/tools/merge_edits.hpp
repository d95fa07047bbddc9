// Merging of edits: several edits of one action as one paste, so that one undo takes all of them
// back.
#pragma once
#include <vector>

#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// Returns one paste with the effect of these edits, or the edits themselves if a paste cannot hold
/// it: if their masks differ, if they are farther apart than 128 voxels along an axis, or if the
/// clipboard becomes too long. Where edits overlap the last one counts. The mask is checked against
/// the voxels before all of the edits. Requires valid edits that have voxels. Cost: O(rows of the
/// edits).
std::vector<EditDescriptor> merge_edits(std::vector<EditDescriptor> edits);

}  // namespace runstone
