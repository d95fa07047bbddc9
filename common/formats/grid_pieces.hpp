// GridPieces: makes pieces of a box whose cells come one after the other, as arrays of other formats
// have them. It appends to the runs of the pieces of one slab, so neither the box nor a piece is
// expanded.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {

/// The cells of a slab of one voxel across the slowest axis, at most, so that the pieces of a slab take
/// at most some 10 MiB without their runs.
inline constexpr std::uint64_t kGridLayerMax = std::uint64_t{1} << 28;

class GridPieces {
 public:
  /// Fails with limit_exceeded if a side is outside 1 .. kBuildSideMax, or a layer has more than
  /// kGridLayerMax cells. `origin` is the lowest voxel of the box, and `order` that in which the cells
  /// come. `blocks` and `sink` must outlive the object; blocks may be added while cells are appended, up
  /// to kMaterialCountMax - 1. Pieces have sides of 64.
  static Result<GridPieces> of(VoxelPos sides, VoxelPos origin, AxisOrder order,
                               const std::vector<ForeignBlock>& blocks, const PieceSink& sink);

  /// Appends equal cells: the index of a block + 1, or 0. Gives the pieces of a slab to the sink when
  /// the slab is full. Fails if the sink does. Requires as many cells as are missing, at least. Cost:
  /// O(lines of pieces).
  Result<void> append(std::uint64_t count, Material cell);
  /// Returns the number of cells that are missing.
  std::uint64_t left() const { return left_; }
  /// Returns the cells to the end of the line of the next piece, 1 .. 64; 0 at the end.
  std::uint32_t line_left() const;

 private:
  GridPieces(const std::vector<ForeignBlock>& blocks, const PieceSink& sink)
      : blocks_(&blocks), sink_(&sink) {}
  void begin_slab();
  Result<void> finish_slab();

  const std::vector<ForeignBlock>* blocks_;
  const PieceSink* sink_;
  AxisOrder order_ = AxisOrder::xyz;
  std::array<std::uint32_t, 3> sides_{};  // fastest, middle, slowest
  std::array<std::int32_t, 3> origin_{};  // x, y, z
  std::array<std::uint32_t, 3> at_{};     // fastest, middle, slowest
  std::uint64_t left_ = 0;
  std::uint32_t pieces_along_ = 1;  // the fastest axis
  std::vector<RunBuilder> runs_;    // of the slab
};

}  // namespace runstone
