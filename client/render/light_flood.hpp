// LightFlood: spreads light through a box of voxels, from its sources to every place within reach:
// over faces, and over edges beside which a voxel is not opaque. Light of a level is spread before
// that of lower levels (Dial 1969), so most voxels are visited once. Pure.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/render/light_levels.hpp"

namespace runstone {

class LightFlood {
 public:
  /// The flood changes the levels of open voxels only. It spreads the light of fixed voxels, but
  /// does not change it.
  struct Voxel {
    LightPass pass = LightPass::opaque;
    bool is_fixed = false;
  };

  /// Makes a box of opaque voxels without light. The outermost voxels must stay opaque or fixed.
  void reset(int size_x, int size_y, int size_z);
  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) + stride_y_ * static_cast<std::size_t>(y) +
           stride_z_ * static_cast<std::size_t>(z);
  }
  std::size_t stride_y() const { return stride_y_; }
  std::size_t stride_z() const { return stride_z_; }
  Voxel& voxel(std::size_t i) { return voxels_[i]; }
  LightLevels& levels(std::size_t i) { return levels_[i]; }
  /// Lets a voxel with light spread it. Requires a voxel inside the outermost ones.
  void add_source(std::size_t i) { push(i, brightest_of(levels_[i])); }
  /// Spreads the light of all sources. Cost: O(voxels that become brighter).
  void run();
  std::size_t byte_size() const {
    return voxels_.capacity() * sizeof(Voxel) + levels_.capacity() * sizeof(LightLevels);
  }

 private:
  void push(std::size_t i, std::uint32_t level) {
    if (level > kFaceStep) waiting_[level].push_back(static_cast<std::uint32_t>(i));
  }
  void spread(std::size_t i);
  void light(std::size_t i, LightLevels from, std::uint32_t step);

  std::size_t stride_y_ = 0, stride_z_ = 0;
  std::vector<Voxel> voxels_;
  std::vector<LightLevels> levels_;
  std::array<std::vector<std::uint32_t>, kLightMax + 1> waiting_;  // by level
};

}  // namespace runstone
