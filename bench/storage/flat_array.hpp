// FlatArray: one material a voxel, in the axis order of the runs from which it is made. Source:
// thesis 3.3.1, 3.3.3.
#pragma once
#include <algorithm>
#include <vector>

#include "bench/storage/heap_bytes.hpp"
#include "bench/storage/strides.hpp"
#include "bench/storage/voxel_store.hpp"
#include "common/runs/dense.hpp"

namespace runstone::bench::storage {

class FlatArray {
 public:
  explicit FlatArray(const RunChunk& chunk)
      : extent_(chunk.extent),
        order_(chunk.order),
        strides_(chunk.extent, chunk.order),
        voxels_(to_dense(chunk)) {}

  Material at(LocalPos at) const { return voxels_[strides_.index(at)]; }
  void set(LocalPos at, Material material) { voxels_[strides_.index(at)] = material; }
  void paint(const Ball& ball, Material material) {
    const OrderedExtent e = ordered(extent_, order_);
    ball.for_each_row(extent_, order_, [&](OrderedPos first, std::uint32_t count) {
      std::fill_n(voxels_.data() + index_of(first, e), count, material);
    });
  }
  template <class F>
  void walk(F&& stretch) const {
    for (const Material material : voxels_) stretch(1u, material);
  }
  std::size_t byte_size() const {
    return sizeof *this + heap_bytes(voxels_.capacity() * sizeof(Material));
  }

 private:
  Extent extent_;
  AxisOrder order_;
  Strides strides_;
  std::vector<Material> voxels_;
};
static_assert(VoxelStore<FlatArray>);

}  // namespace runstone::bench::storage
