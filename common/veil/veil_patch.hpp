// VeilPatch: voxels of a shown chunk that get other materials, as spans of the flattened chunk.
// Canonical form: the order is kVeilOrder, the spans ascend and do not overlap, and two spans that
// touch differ in material. So equal changes have equal spans. Holders apply a patch in their own
// axis order.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/extent.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// Voxels [first, first + count) become `material`.
struct VeilSpan {
  VoxelIndex first = 0;
  std::uint32_t count = 0;
  Material material = kEmpty;
  friend bool operator==(const VeilSpan&, const VeilSpan&) = default;
};

struct VeilPatch {
  Extent extent;
  AxisOrder order = AxisOrder::xyz;
  std::vector<VeilSpan> spans;

  bool empty() const { return spans.empty(); }
  friend bool operator==(const VeilPatch&, const VeilPatch&) = default;
};

/// Checks a patch in any axis order. Fails with the first broken invariant. The offset of the error
/// is the number of the span. Call it before you use a patch from outside.
Result<void> validate(const VeilPatch& patch);

/// Returns the same changes in another axis order. Requires a valid patch. Cost: O(n log n) for n
/// lines of the new order in which a span has voxels.
VeilPatch in_order(const VeilPatch& patch, AxisOrder order);

/// Applies a patch in any axis order. Returns true if a voxel changed. Requires a valid patch of
/// the chunk's extent. Cost: O(runs + spans), plus the cost of in_order().
bool apply_patch(const VeilPatch& patch, RunChunk& chunk);

}  // namespace runstone
