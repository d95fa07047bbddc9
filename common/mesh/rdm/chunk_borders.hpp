// ChunkBorders: the opaque voxels of the six outermost layers of a chunk, one bit per voxel. It is
// the helper structure for borders that thesis 9.1 proposes. A holder that keeps it beside a chunk
// saves the meshes of the six neighbours from reading runs that lie far from them. It pays where
// whole chunks are meshed again and again. The client of this project meshes most chunks once and
// does not keep it (docs/meshing.md).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

class ChunkBorders {
 public:
  /// Replaces all six sides by those of `chunk`. For a chunk of one material nothing is kept,
  /// because its single run is a shorter summary. The contents hold for this version of the chunk
  /// and this table. Allocates for the first chunk of a size. Cost: O(runs).
  void read(const RunChunk& chunk, const VisibilityTable& visibility);

  /// Does the same from rows that are known: those of each side, with bits and rows along the axes
  /// of side_axes(), and whether each side has transparent voxels.
  template <class Rows>
  void keep(const RunChunk& chunk, const std::array<Rows, kDirectionCount>& sides,
            const std::array<bool, kDirectionCount>& transparent);

  bool empty() const { return words_.empty(); }
  /// Returns true if extent and axis order are those of the chunk, and the borders are of a chunk
  /// of several materials.
  bool fits(const RunChunk& chunk) const {
    return !empty() && extent_ == chunk.extent && order_ == chunk.order;
  }
  /// Returns true if a side has transparent voxels.
  bool has_transparent(Direction side) const {
    return transparent_[static_cast<std::size_t>(side)];
  }
  /// Returns the axis along the bits of a side's rows.
  Axis bit_axis(Direction side) const { return bit_axis_[static_cast<std::size_t>(side)]; }
  /// Returns the opaque voxels of a side, in rows of row_words() words, lowest bits first.
  const std::uint32_t* rows(Direction side) const {
    return words_.data() + first_[static_cast<std::size_t>(side)];
  }
  std::size_t row_words(Direction side) const { return row_words_[static_cast<std::size_t>(side)]; }
  std::size_t row_count(Direction side) const { return row_count_[static_cast<std::size_t>(side)]; }
  /// Returns the heap bytes allocated.
  std::size_t byte_size() const { return words_.capacity() * sizeof(std::uint32_t); }

 private:
  void lay_out(const RunChunk& chunk);
  template <class Row>
  void read_sides(const RunChunk& chunk, const VisibilityTable& visibility);
  template <class Rows>
  void keep_side(Direction side, const Rows& rows);

  std::vector<std::uint32_t> words_;
  Extent extent_;
  AxisOrder order_{};
  std::array<std::uint16_t, kDirectionCount> first_{};
  std::array<std::uint8_t, kDirectionCount> row_words_{}, row_count_{};
  std::array<Axis, kDirectionCount> bit_axis_{};
  std::array<bool, kDirectionCount> transparent_{};
};

}  // namespace runstone
