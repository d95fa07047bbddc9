// PieceRows: cuts the cells of a box, which come row by row as many formats store them (x fastest, then
// z, then y), into pieces of at most 64 voxels a side (128 along x and z if the box is very wide) at the
// planes of the grid with that edge, as builds have them. It holds the runs of one slab of layers, never
// a grid.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {

/// The cells of a box that a file may have.
inline constexpr std::uint64_t kPieceRowsVolumeMax = (std::uint64_t{1} << 31) - 1;

class PieceRows {
 public:
  /// Material i + 1 of the cells is blocks[i], and 0 is a cell of which the file says nothing. Blocks and
  /// sink must outlive it; blocks may be added while cells are appended. Requires sides of at least
  /// 1 with at most kPieceRowsVolumeMax cells.
  PieceRows(const VoxelBox& box, const std::vector<ForeignBlock>& blocks, const PieceSink& sink);

  /// Returns the number of cells that are not appended yet.
  std::uint64_t left() const { return left_; }
  /// Appends cells, and gives the pieces of a slab to the sink when it is full, also those of
  /// which the file says nothing. Fails as the sink does.
  /// Requires count <= left(), and a material of at most blocks.size(). Cost: O(rows of tiles).
  Result<void> append(std::uint64_t count, Material material);

 private:
  void begin_slab();
  void advance();
  Result<void> give_slab();
  ForeignPiece piece_of(RunChunk cells, VoxelPos origin);

  VoxelPos low_;
  std::uint32_t width_, height_, length_;
  std::uint32_t tile_;  // edge of a tile along x and z
  // How far the planes of the grid lie below the low corner, which is less than an edge.
  std::uint32_t offset_x_, offset_y_, offset_z_;
  std::uint32_t tiles_x_, tiles_z_;
  const std::vector<ForeignBlock>& blocks_;
  const PieceSink& sink_;
  std::uint64_t left_;
  std::vector<RunBuilder> tiles_;  // of the slab, x fastest
  std::uint32_t slab_y_ = 0, slab_layers_ = 0;
  // The place of the next cell: a layer of the slab, a row, a tile along x. Rows and layers that are
  // contiguous in a tile are one span.
  std::uint32_t y_ = 0, z_ = 0, tile_x_ = 0;
  std::uint32_t span_left_ = 0, span_rows_ = 0, span_layers_ = 0;
  std::vector<Material> numbers_;  // in a piece, by material; 0: not there yet
};

}  // namespace runstone
