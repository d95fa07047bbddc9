// CellList: voxels with a material each, from which a tool makes one paste.
#pragma once
#include <vector>

#include "client/tools/tool.hpp"
#include "common/core/coords.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

struct Cell {
  VoxelPos at;
  Material material = kEmpty;
};

/// Returns one paste that sets these voxels where the mask admits it. If a voxel is listed twice,
/// its first entry counts. Fails with words for the player if there are no cells, if they are
/// farther apart than 128 voxels along an axis, or if the clipboard becomes too long. Cost: O(cells
/// log cells).
ToolEdits paste_of(std::vector<Cell> cells, Mask mask);

}  // namespace runstone
