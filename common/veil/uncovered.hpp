// Uncovered voxels: the voxels that a veiled chunk must show after its true voxels changed.
//
// One shown chunk stands beside each true one. It begins as the veil of the true chunk. The two
// satisfy this rule at every moment: a voxel shows its true material, or it is enclosed in the true
// chunk and shows a material that covers. So both have the same faces, rays, collisions and light,
// and the same edits may be applied to both. There are two exceptions: edits that compare materials
// (MaskKind::only_material), and edits that restore voxels. After an edit of the true chunk,
// find_uncovered() returns the changes of the shown chunk with which it satisfies the rule again.
// If an edit uncovers no voxel, it need not be applied to the shown chunk at all. A voxel that has
// once shown its true material keeps it, because no change covers it again.
#pragma once
#include <array>

#include "common/core/coords.hpp"
#include "common/runs/dirty_layers.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/veil/veil.hpp"
#include "common/veil/veil_borders.hpp"
#include "common/veil/veil_patch.hpp"

namespace runstone {

/// Returns the layers in which an edit can uncover voxels: the layers in which voxels changed, the
/// layers on either side of these, and the layers beside changes in the touching layer of a
/// neighbour. `beyond` is by Direction.
SlowLayers layers_beside(const RunChunk& chunk, const DirtyLayers& dirty,
                         const std::array<DirtyLayers, kDirectionCount>& beyond);

/// Replaces `patch` by the changes that make the shown chunk satisfy the rule above, in the axis
/// order of the true chunk. A voxel of the layers whose true material differs from the shown
/// material is in the patch
///   - with its true material, if it is not enclosed;
///   - with the filler, if it is enclosed and shows a material that does not cover.
/// Requires valid chunks of one extent and one axis order, the borders of the true chunk beside the
/// layers, and a filler that covers. Cost: O(lines of the layers + runs of both chunks in them +
/// log runs).
void find_uncovered(const RunChunk& truth, const VeilBorders& borders, const RunChunk& shown,
                    const VeilMaterials& materials, SlowLayers layers, VeilScratch& scratch,
                    VeilPatch& patch);

}  // namespace runstone
