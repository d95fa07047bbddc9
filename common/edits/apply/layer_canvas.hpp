// LayerCanvas: the voxels of one layer while a stack of edits is drawn on it, a line after another, never more
// than the layer at hand (so no dense expansion). Scratch of the layer painter. Internal to edits.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/core/ids.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone {

/// Lines begin on cache lines and are padded to whole ones, so that vectors may load and store beyond their end.
class LayerCanvas {
 public:
  /// Voxels from one line to the next are a multiple of this.
  static constexpr std::uint32_t kBlock = 32;

  /// Makes room for a layer of this shape; what lies in it is unspecified.
  void fit(OrderedExtent e) {
    line_blocks_ = (e.f + kBlock - 1) / kBlock;
    const std::size_t blocks =
        std::size_t{2} + line_blocks_ * e.m;  // one to either side is touched as well
    if (blocks_.size() < blocks) blocks_.resize(blocks);
  }
  Material* line(std::uint32_t m) { return blocks_[1 + m * line_blocks_].voxels.data(); }
  std::uint32_t stride() const { return line_blocks_ * kBlock; }

 private:
  struct alignas(64) Block {
    std::array<Material, kBlock> voxels{};
  };
  static_assert(sizeof(Block) == kBlock * sizeof(Material));
  std::vector<Block> blocks_;
  std::uint32_t line_blocks_ = 0;
};

}  // namespace runstone
