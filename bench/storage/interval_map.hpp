// IntervalMap: the runs of a flattened chunk in a balanced tree, so that an edit moves no other
// runs. The tree is a std::map from the end of each interval to its material. Intervals tile the
// chunk, and neighbours differ. Source: thesis 3.7.2; M. Lysenko, "An Analysis of Minecraft-like
// Engines" (0fps, 2012).
#pragma once
#include <map>

#include "bench/storage/heap_bytes.hpp"
#include "bench/storage/strides.hpp"
#include "bench/storage/voxel_store.hpp"

namespace runstone::bench::storage {

class IntervalMap {
 public:
  explicit IntervalMap(const RunChunk& chunk)
      : extent_(chunk.extent), order_(chunk.order), strides_(chunk.extent, chunk.order) {
    for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
      ends_.emplace_hint(ends_.end(), chunk.runs.end(i), chunk.runs.material(i));
    }
  }

  Material at(LocalPos at) const { return ends_.upper_bound(strides_.index(at))->second; }
  void set(LocalPos at, Material material) {
    const VoxelIndex voxel = strides_.index(at);
    fill(voxel, voxel + 1, material);
  }
  void paint(const Ball& ball, Material material) {
    const OrderedExtent e = ordered(extent_, order_);
    ball.for_each_row(extent_, order_, [&](OrderedPos first, std::uint32_t count) {
      fill(index_of(first, e), index_of(first, e) + count, material);
    });
  }
  template <class F>
  void walk(F&& stretch) const {
    VoxelIndex begin = 0;
    for (const auto& [end, material] : ends_) {
      stretch(end - begin, material);
      begin = end;
    }
  }
  std::size_t byte_size() const { return sizeof *this + ends_.size() * heap_bytes(sizeof(Node)); }
  std::size_t interval_count() const { return ends_.size(); }

 private:
  using Ends = std::map<VoxelIndex, Material>;
  /// The layout of a node of libstdc++ and libc++.
  struct Node {
    void *parent, *left, *right;
    long colour;
    Ends::value_type value;
  };

  /// Sets voxels [first, last) to `material`. Requires first < last. Cost: O(log intervals +
  /// intervals replaced).
  void fill(VoxelIndex first, VoxelIndex last, Material material) {
    auto at = ends_.upper_bound(first);
    if (at->second == material && last <= at->first) return;
    const bool whole = at == ends_.begin() ? first == 0 : std::prev(at)->first == first;
    if (!whole) {
      // The part before `first` stays, unless it has the new material.
      if (at->second != material) ends_.emplace_hint(at, first, at->second);
    } else if (at != ends_.begin() && std::prev(at)->second == material) {
      ends_.erase(std::prev(at));  // the new interval includes it
    }
    while (at != ends_.end() && at->first <= last) at = ends_.erase(at);
    if (at == ends_.end() || at->second != material) ends_.emplace_hint(at, last, material);
  }

  Extent extent_;
  AxisOrder order_;
  Strides strides_;
  Ends ends_;
};
static_assert(VoxelStore<IntervalMap>);

}  // namespace runstone::bench::storage
