// GridPieces: cuts the cells of a box, which come one after the other as arrays of other formats have
// them, into pieces of at most 64 voxels a side (128 along the two faster axes if a layer is very
// large), at the planes of the grid with that edge, as builds have them. It holds the runs of the pieces
// of one slab of layers, so neither the box nor a piece is expanded. Internal to readers.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {

/// The cells of a layer across the slowest axis, at most, that are cut into small pieces. The pieces of
/// a slab take at most some 10 MiB without their runs.
inline constexpr std::uint64_t kGridLayerMax = std::uint64_t{1} << 28;
/// The cells of a box in a schematic.
inline constexpr std::uint64_t kGridVolumeMax = (std::uint64_t{1} << 31) - 1;

class GridPieces {
 public:
  /// `order` is that in which the cells come. Material i + 1 of the cells is blocks[i], and 0 is a cell
  /// of which the file says nothing. `blocks` and `sink` must outlive the object; blocks may be added
  /// while cells are appended. Requires a box that is not empty, and whose layers have at most
  /// kGridVolumeMax cells.
  GridPieces(const VoxelBox& box, AxisOrder order, const std::vector<ForeignBlock>& blocks,
             const PieceSink& sink);
  GridPieces(const GridPieces&) = delete;
  GridPieces& operator=(const GridPieces&) = delete;

  /// Returns true if each side is 1 .. kBuildSideMax, and a layer has at most kGridLayerMax cells.
  static bool are_sides(VoxelPos sides, AxisOrder order);

  /// Returns the number of cells that are not appended yet.
  std::uint64_t left() const { return left_; }
  /// Appends equal cells, and gives the pieces of a slab to the sink when it is full, also those of
  /// which the file says nothing. Fails as the sink does. Requires count <= left(), and a material of at
  /// most blocks.size(). Cost: O(lines of pieces); O(1) in a piece as wide as the box.
  Result<void> append(std::uint64_t count, Material material);

 private:
  /// Cells of a side from `begin` to `end`.
  struct Span {
    std::uint32_t begin, end;
    std::uint32_t size() const { return end - begin; }
  };
  /// A side of the box.
  struct Side {
    std::size_t axis = 0;      // 0: x, 1: y, 2: z
    std::int32_t low = 0;      // of the box, in the world
    std::uint32_t cells = 0;   // at least 1
    std::uint32_t edge = 0;    // of the grid
    std::uint32_t offset = 0;  // how far the plane of the grid lies below `low`, less than an edge

    std::uint32_t pieces() const { return (offset + cells + edge - 1) / edge; }
    std::uint32_t piece_at(std::uint32_t cell) const { return (offset + cell) / edge; }
    Span span(std::uint32_t piece) const;
  };

  void begin_slab();
  void advance();
  Result<void> give_slab();
  ForeignPiece piece_of(RunChunk cells, VoxelPos origin);

  AxisOrder order_;
  Side fast_, middle_, slow_;
  const std::vector<ForeignBlock>& blocks_;
  const PieceSink& sink_;
  std::uint32_t wide_ = 1;  // pieces along the fastest axis
  std::uint64_t left_ = 0;
  std::vector<RunBuilder> pieces_;  // of the slab, the fastest axis first
  Span slab_{0, 0};                 // layers
  // The place of the next cell: a layer of the slab, a row, a piece along the fastest axis. Rows and
  // layers that are contiguous in a piece are one span.
  std::uint32_t layer_ = 0, row_ = 0, piece_ = 0;
  std::uint32_t span_left_ = 0, span_rows_ = 0, span_layers_ = 0;
  std::size_t open_ = 0;           // index of the piece of the span
  std::vector<Material> numbers_;  // in a piece, by material; 0: not there yet
};

}  // namespace runstone
