// MaterialOctree: voxels as Voxel Plugin stores them (thesis 6.3.1), for the culled baseline to
// sample. A cube is divided into eight parts until a part is of one material or a brick of 16 x 16
// x 16 voxels.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/core/coords.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/reference/dense_grid.hpp"

namespace runstone::reference {

class MaterialOctree {
 public:
  static constexpr std::int32_t kBrickSide = 16;  // voxels
  static constexpr unsigned kDepthMax = 6;

  /// Makes an empty cube of kBrickSide << depth voxels a side whose first voxel is `origin`.
  /// Requires depth <= kDepthMax.
  MaterialOctree(VoxelPos origin, unsigned depth);

  /// Writes a chunk's voxels. Voxels outside the cube are left out. Call compact() after the last
  /// chunk. Cost: O(volume / 16 + runs).
  void insert(VoxelPos first, const RunChunk& chunk);
  /// Makes every part of one material a single node. Cost: O(bricks).
  void compact();

  /// Fills `grid`, its border and the edges of the border, with the voxels from `first` on (the
  /// grid's voxel 0 0 0); empty outside the cube. Counts a dense expansion. Requires a grid of
  /// order xyz. Cost: O(volume + nodes met).
  void sample(VoxelPos first, DenseGrid& grid) const;

  std::size_t byte_size() const {
    return nodes_.size() * sizeof(Node) + bricks_.size() * sizeof(Brick);
  }

 private:
  // x fastest, z slowest.
  using Brick = std::array<Material, std::size_t{kBrickSide} * kBrickSide * kBrickSide>;
  struct Node {
    std::uint32_t children = 0;  // the first of eight nodes, x fastest; 0: none
    std::uint32_t brick = 0;     // index + 1; 0: none
    Material material = kEmpty;  // of the whole part, if it has neither children nor brick
  };

  Brick& brick_at(std::int32_t x, std::int32_t y, std::int32_t z);
  bool compact(std::uint32_t node, MaterialOctree& into, std::uint32_t to) const;
  void sample(const Node& node, VoxelPos at, std::int32_t side, const VoxelBox& wanted,
              DenseGrid& grid) const;
  std::int32_t side() const { return kBrickSide << depth_; }

  VoxelPos origin_;
  unsigned depth_;
  std::vector<Node> nodes_;  // [0] is the root
  std::vector<Brick> bricks_;
};

}  // namespace runstone::reference
