// MaterialOctree: voxels the way Voxel Plugin keeps them (thesis 6.3.1), as a store for the culled baseline
// to sample from: a cube split in eight until a part is of one material or a brick of 16 x 16 x 16 voxels.
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

  /// An empty cube of kBrickSide << depth voxels a side whose first voxel is `origin`. Requires depth <=
  /// kDepthMax.
  MaterialOctree(VoxelPos origin, unsigned depth);

  /// Writes a chunk's voxels; what lies outside the cube is left out. O(volume / 16 + runs). Call compact()
  /// behind the last one.
  void insert(VoxelPos first, const RunChunk& chunk);
  /// Makes every part of one material a single node. O(bricks).
  void compact();

  /// Fills `grid`, border and its edges included, with the voxels from `first` on (the grid's voxel 0 0 0);
  /// empty outside the cube. Counts a dense expansion. Requires a grid of order xyz. O(volume + nodes met).
  void sample(VoxelPos first, DenseGrid& grid) const;

  std::size_t byte_size() const {
    return nodes_.size() * sizeof(Node) + bricks_.size() * sizeof(Brick);
  }

 private:
  using Brick = std::array<Material, std::size_t{kBrickSide} * kBrickSide *
                                         kBrickSide>;  // x fastest, z slowest
  struct Node {
    std::uint32_t children = 0;  // the first of eight nodes, x fastest; 0: none
    std::uint32_t brick = 0;     // index + 1; 0: none
    Material material = kEmpty;  // of the whole part, if it has neither
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
