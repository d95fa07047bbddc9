// ChunkBorders: what the six outermost layers of a chunk hide, a bit a voxel. The helper structure for borders
// that thesis 9.1 asks for: whoever keeps it adjacent a chunk spares the meshes of the six chunks around it
// from reading runs that lie nowhere near them. It pays where whole chunks are meshed again and again; our
// client meshes most of them once and does not keep it (docs/meshing.md).
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
  /// Replaces all six sides by those of `chunk`; of one of a single material, which is its own best summary,
  /// nothing is kept. What it says holds for this version of the chunk and this table. O(runs); allocates for
  /// the first chunk of a size.
  void read(const RunChunk& chunk, const VisibilityTable& visibility);

  /// The same from rows that are known: of each side, along the bits and from row to row as side_axes() has
  /// them, and whether it has transparent voxels.
  template <class Rows>
  void keep(const RunChunk& chunk, const std::array<Rows, kDirectionCount>& sides,
            const std::array<bool, kDirectionCount>& transparent);

  bool empty() const { return words_.empty(); }
  /// Whether it may be that of a chunk of several materials, by its extent and axis order.
  bool fits(const RunChunk& chunk) const {
    return !empty() && extent_ == chunk.extent && order_ == chunk.order;
  }
  /// Whether a side has transparent voxels.
  bool has_transparent(Direction side) const {
    return transparent_[static_cast<std::size_t>(side)];
  }
  /// The axis along the bits of a side's rows.
  Axis bit_axis(Direction side) const { return bit_axis_[static_cast<std::size_t>(side)]; }
  /// Opaque voxels of a side, in rows of row_words() words, lowest bits first.
  const std::uint32_t* rows(Direction side) const {
    return words_.data() + first_[static_cast<std::size_t>(side)];
  }
  std::size_t row_words(Direction side) const { return row_words_[static_cast<std::size_t>(side)]; }
  std::size_t row_count(Direction side) const { return row_count_[static_cast<std::size_t>(side)]; }
  /// Heap bytes held.
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
