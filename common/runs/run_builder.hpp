// RunBuilder: appends stretches in index order and merges equal neighbours, so the result is
// canonical. Generators, decoders and the edit sweep make all their chunks with it.
#pragma once
#include <cstdint>

#include "common/runs/run_chunk.hpp"

namespace runstone {

class RunBuilder {
 public:
  RunBuilder(Extent extent, AxisOrder order);

  /// Returns the number of voxels appended so far.
  std::uint32_t filled() const { return filled_; }
  /// Appends `count` voxels; 0 is allowed and does nothing. Requires filled() + count <= volume.
  /// Cost: O(1) amortised.
  void append(std::uint32_t count, Material material);
  /// Appends voxels up to index `end`. Requires filled() <= end <= volume.
  void append_to(std::uint32_t end, Material material) { append(end - filled_, material); }
  /// Returns the chunk and leaves the builder empty. Requires filled() == volume.
  RunChunk finish();

 private:
  void flush();
  RunChunk chunk_;
  std::uint32_t filled_ = 0;
  // Material of the run that still grows. Meaningful while filled_ > 0.
  Material open_ = kEmpty;
};

}  // namespace runstone
