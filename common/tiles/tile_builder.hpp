// Tile builder: makes a tile (a chunk at a level of detail) from the runs of its eight children,
// without a dense grid. A tile has the edge of its children and voxels twice as wide, so it covers
// two children along each axis.
//
// The rule: a voxel of a tile takes the material of the most exposed of its 2 x 2 x 2 voxels in the
// children. The exposure of a voxel is the number of its six faces that are drawn
// (VisibilityTable::face_drawn). Faces towards the outside of the eight children do not count, so a
// tile is a pure function of its children. Of equally exposed voxels the upper one wins (greater
// y), then the one with the lower x, then the one with the lower z. So thin walls, roofs and single
// voxels stay visible, and a surface keeps the material of its upper side.
#pragma once
#include <array>
#include <memory>

#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The children of a tile. Child i lies at x = i & 1, y = i >> 1 & 1, z = i >> 2. A child that is
/// null is empty.
using TileChildren = std::array<const RunChunk*, 8>;

/// The buffers that calls reuse. A scratch belongs to one thread, and callers do not use its
/// contents.
class TileScratch {
 public:
  TileScratch();
  ~TileScratch();
  TileScratch(TileScratch&&) noexcept;
  TileScratch& operator=(TileScratch&&) noexcept;
  struct State;
  State& state() { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

/// Returns the tile of `children` in axis order `order`. Requires `edge` 16, 32, 64 or 128, and
/// valid children that are cubes of that edge, in any axis order. Thread: any, with one scratch
/// each. In a steady state only the result allocates. Cost:
///   - O(runs and lines of the children + runs of the tile);
///   - a few instructions for 64 voxels of each line in layers that are not uniform;
///   - for a child in another axis order, also O(segments of its lines along that order), which is
///     about as much again;
///   - O(layers) for uniform children.
RunChunk build_tile(const TileChildren& children, unsigned edge, AxisOrder order,
                    const VisibilityTable& visibility, TileScratch& scratch);

}  // namespace runstone
