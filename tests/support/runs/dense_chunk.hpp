// DenseChunk: the oracle for run chunks. It has a flat vector of materials, per-voxel loops, its
// own index arithmetic and its own digest. It shares no code with common/runs and no formula with
// its fast paths. Every new DenseChunk counts as a dense expansion (copies do not), because the
// rule "runs from end to end" requires oracles to count theirs (common/runs/dense.hpp).
#pragma once
#include <iosfwd>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/digest.hpp"
#include "common/core/ids.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::test {

class DenseChunk {
 public:
  /// Makes a chunk of empty voxels. Unlike a RunChunk it accepts any sides from 1 up.
  explicit DenseChunk(Extent extent);
  /// Expands runs voxel by voxel. Requires a chunk that validates.
  static DenseChunk of(const RunChunk& chunk);

  Extent extent() const { return extent_; }
  int side_x() const { return extent_.x; }
  int side_y() const { return extent_.y; }
  int side_z() const { return extent_.z; }
  bool inside(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < side_x() && y < side_y() && z < side_z();
  }
  /// Reads and writes a voxel. Both require inside(x, y, z).
  Material at(int x, int y, int z) const { return voxels_[slot(x, y, z)]; }
  void set(int x, int y, int z, Material material) { voxels_[slot(x, y, z)] = material; }

  /// Sets the `count` voxels that follow `first` in the flattened order of `order`, one by one.
  /// Returns whether any voxel changed.
  bool fill(AxisOrder order, VoxelIndex first, std::uint32_t count, Material material);

  /// Returns the sum over single voxels, with tables derived here from the definition and plain
  /// remainders.
  Digest digest() const;

  /// Returns the number of runs in `order`, counted voxel by voxel.
  std::uint32_t run_count(AxisOrder order) const;

  friend bool operator==(const DenseChunk&, const DenseChunk&) = default;

 private:
  std::size_t slot(int x, int y, int z) const;
  Extent extent_;
  std::vector<Material> voxels_;  // x fastest, then y, then z
};

/// Returns the position of the voxel with flattened index `index`, counted axis by axis from the
/// order's name.
VoxelPos dense_pos(Extent extent, AxisOrder order, std::uint32_t index);

/// Returns the first voxel at which two chunks of one extent differ (x fastest), for failure
/// messages.
std::optional<VoxelPos> first_difference(const DenseChunk& a, const DenseChunk& b);

/// Prints "DenseChunk 8x9x10".
std::ostream& operator<<(std::ostream& out, const DenseChunk& chunk);

}  // namespace runstone::test
