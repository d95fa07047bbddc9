// LayerCanvas: the voxels of one layer, line by line, on which a stack of edits is drawn. It never
// holds more than the current layer, so it is no dense expansion. Scratch of the layer painter.
// Internal to edits.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/core/ids.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone {

/// Lines begin on cache lines and are padded to whole ones, so that vectors may load and store
/// beyond their end.
class LayerCanvas {
 public:
  /// The distance from one line to the next is a multiple of this number of voxels.
  static constexpr std::uint32_t kBlock = 32;

  /// Makes room for a layer of this shape. Its contents are unspecified.
  void fit(OrderedExtent e) {
    line_blocks_ = (e.f + kBlock - 1) / kBlock;
    // Vectors may reach into one block before the first line and one behind the last.
    const std::size_t blocks = std::size_t{2} + line_blocks_ * e.m;
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
