// cut_edit(): cuts an edit of any size into edits that a server accepts, by geometry. The pieces are
// aligned to chunks, so each chunk is touched by as few pieces as possible. The pieces do not
// overlap, and together have the effect of the whole.
#pragma once
#include <memory>

#include "client/build/edit_source.hpp"
#include "protocol/rules/edit_check.hpp"

namespace runstone {

/// Returns true if the edit is too large for one descriptor in a world with these limits: by its
/// voxels, its chunks, or the sides of its box.
bool needs_cut(const EditDescriptor& edit, const EditLimits& limits);

/// Returns a source of the pieces of a box. Unlike that of FillBox, its sides may have any length.
/// Parts outside the heights of the world are left out. A piece is a box of whole chunks, cut to the
/// box, with at most limits.volume_max voxels and limits.touched_chunks_max chunks.
std::unique_ptr<EditSource> cut_box(const VoxelBox& box, const Mask& mask, Material material,
                                    const EditLimits& limits);

/// Returns a source of the pieces of any edit with voxels: boxes as cut_box() does, other shapes as
/// a paste for each box of chunks that they touch. An edit that needs no cut is its own only piece.
/// Cost of a piece: O(runs).
std::unique_ptr<EditSource> cut_edit(const EditDescriptor& edit, const EditLimits& limits);

}  // namespace runstone
