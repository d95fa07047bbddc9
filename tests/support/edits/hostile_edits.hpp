// Edits that cost a server as much as it allows. The attack lab and the crash tests send them.
#pragma once
#include <memory>

#include "common/core/assert.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone::test {

/// Returns a clipboard of 47,000 runs, a byte each: about the longest that an edit may have.
inline std::shared_ptr<const Clipboard> long_clipboard() {
  constexpr std::uint32_t kRuns = 47'000;
  const Extent extent{128, 125, 3};
  RunChunk cells{extent, AxisOrder::xyz, RunList(extent.volume())};
  for (std::uint32_t end = 1; end <= kRuns; ++end) {
    cells.runs.push_back(
        {end == kRuns ? extent.volume() : end, static_cast<Material>(1 + end % 2)});
  }
  auto clipboard = Clipboard::of({1, 2}, std::move(cells));
  RUNSTONE_ASSERT(clipboard.has_value());
  return *std::move(clipboard);
}

/// Returns a box of 922,624 voxels in one layer, whose smallest corner is `corner`.
inline EditDescriptor wide_box(const VoxelPos& corner, Material material) {
  return {FillBox{{corner, {corner.x + 1'024, corner.y + 1, corner.z + 901}}}, {}, material};
}

}  // namespace runstone::test
