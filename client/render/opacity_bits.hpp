// OpacityBits: one bit for each voxel of a chunk: set if its material is opaque. The bits stand in
// the axis order of the chunk's runs, so a run is a range of bits. They darken corners (ambient
// occlusion). They hold no materials, so they are no dense expansion; they take 1/16 of its bytes.
// Pure.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// True for each material that is opaque, by id. Ids beyond the end are opaque, as for the mesher.
using OpaqueMaterials = std::vector<bool>;
OpaqueMaterials opaque_materials(const MaterialTable& materials);

struct OpacityBits {
  AxisOrder order{};
  bool all = false;  // every voxel is opaque; then there are no words
  /// Bit i % 32 of word i / 32 is that of voxel i. Empty if all bits are equal.
  std::vector<std::uint32_t> words;
};

/// Returns the bits of a chunk. Requires a volume that is a multiple of 32. Cost: O(runs + volume /
/// 32).
OpacityBits opacity_bits(const RunChunk& chunk, const OpaqueMaterials& opaque);

}  // namespace runstone
