// Patterns for the changes of a brush: a filter leaves some of them out, and a mix gives them their
// materials.
#pragma once
#include "common/core/ids.hpp"
#include "common/patterns/bound_filter.hpp"
#include "common/patterns/bound_mix.hpp"
#include "common/sculpt/column_changes.hpp"
#include "common/sculpt/ground_columns.hpp"

namespace runstone {

/// The material that a brush sets where mixed() is to choose one. It is that of no voxel, except in
/// a world whose table is full.
inline constexpr Material kMixedMaterial = UINT16_MAX;

/// Returns the changes of voxels for which the filter held before the brush. Cost: that of
/// BoundFilter::passing() for each change.
ColumnChanges filtered(const GroundColumns& columns, const ColumnChanges& changes,
                       BoundFilter& filter);

/// Returns the changes with the materials of a mix in place of kMixedMaterial, without the voxels
/// that have them already. Cost: O(changes + voxels of kMixedMaterial * log runs).
ColumnChanges mixed(const GroundColumns& columns, const ColumnChanges& changes, BoundMix& mix);

}  // namespace runstone
