// PaddedGrid: a value for each voxel of a chunk and of the one voxel around it, the input of the
// dense reference meshers. DenseGrid holds materials. It is a type of its own, so that nothing
// dense gets into the product: only this folder, benchmarks and tests use it. It is flattened in an
// axis order like a chunk, so that runs of the same order decode by plain fills.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::reference {

/// The six chunks around a chunk, by Direction, in any axis order, with equal sides where they
/// touch. A null chunk counts as empty.
using GridNeighbours = std::array<const RunChunk*, kDirectionCount>;

template <class VoxelType>
class PaddedGrid {
 public:
  using Voxel = VoxelType;

  /// Sets the shape; the voxels are unspecified afterwards. Allocates only to grow. Requires a
  /// valid extent.
  void reset(Extent extent, AxisOrder order) {
    RUNSTONE_ASSERT(extent.valid());
    extent_ = extent;
    order_ = order;
    sides_ = ordered(extent, order);
    line_stride_ = static_cast<std::ptrdiff_t>(sides_.f) + 2;
    layer_stride_ = line_stride_ * (static_cast<std::ptrdiff_t>(sides_.m) + 2);
    volume_ = static_cast<std::size_t>(layer_stride_) * (sides_.s + 2);
    if (voxels_.size() < volume_ + kSlack) voxels_.resize(volume_ + kSlack);
  }

  Extent extent() const { return extent_; }
  AxisOrder order() const { return order_; }
  /// Returns the sides without the border: fastest, middle and slowest axis.
  OrderedExtent sides() const { return sides_; }
  /// Return the distance in voxels from one line to the next, and from one slow layer to the next,
  /// border included.
  std::ptrdiff_t line_stride() const { return line_stride_; }
  std::ptrdiff_t layer_stride() const { return layer_stride_; }
  /// Returns the distance in voxels from a voxel to the next one along an axis.
  std::ptrdiff_t stride(Axis axis) const {
    const std::array<Axis, 3> axes = axes_of(order_);
    return axis == axes[0] ? 1 : axis == axes[1] ? line_stride_ : layer_stride_;
  }
  /// Returns the bytes of the voxels of grid and border.
  std::size_t byte_size() const { return volume_ * sizeof(Voxel); }

  /// Returns the first voxel of line m of slow layer s. Requires -1 <= m, s <= their side. [-1] and
  /// [side] of a line are its border. The twelve edges of the border belong to no face: decode()
  /// and the octree may write any value there.
  const Voxel* line(std::ptrdiff_t m, std::ptrdiff_t s) const {
    return voxels_.data() + offset(m, s);
  }
  Voxel* line(std::ptrdiff_t m, std::ptrdiff_t s) { return voxels_.data() + offset(m, s); }
  /// Returns the voxel at 0 0 0. Others lie at multiples of stride().
  const Voxel* origin() const { return line(0, 0); }

  /// The number of values behind the last voxel that may be read and overwritten, so that fills and
  /// comparisons need not stop exactly.
  static constexpr std::size_t kSlack = 64;

 private:
  std::ptrdiff_t offset(std::ptrdiff_t m, std::ptrdiff_t s) const {
    return (s + 1) * layer_stride_ + (m + 1) * line_stride_ + 1;
  }
  Extent extent_;
  AxisOrder order_ = AxisOrder::xyz;
  OrderedExtent sides_{};
  std::ptrdiff_t line_stride_ = 0, layer_stride_ = 0;
  std::size_t volume_ = 0;     // border included
  std::vector<Voxel> voxels_;  // volume_ + kSlack or more
};

using DenseGrid = PaddedGrid<Material>;

/// Decodes a chunk and the adjoining layers of its neighbours into a grid of the chunk's axis
/// order, as a dense mesher of a world of runs must do first. Counts a dense expansion. `layer` is
/// scratch. Cost: O(volume), a fill a run.
void decode(const RunChunk& chunk, const GridNeighbours& neighbours, std::vector<Material>& layer,
            DenseGrid& grid);

}  // namespace runstone::reference
