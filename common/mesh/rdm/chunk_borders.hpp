// ChunkBorders: the six outermost layers of a chunk: the opaque voxels, the transparent voxels, and
// the materials of the transparent ones. It is the helper structure for borders that thesis 9.1
// proposes. If the neighbours of a chunk have it, the chunk is meshed without reading their runs.
// mesh_rdm() makes the borders of the chunk that it meshes at little cost. The client keeps them
// beside the meshes (client/schedule/mesh_planner.hpp).
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

class ChunkBorders {
 public:
  /// Replaces all six sides by those of `chunk`. For a chunk of one material nothing is kept,
  /// because its single run is a shorter summary. The contents hold for this version of the chunk
  /// and this table. Allocates only to grow. Cost: O(runs), and O(log runs) for each transparent
  /// voxel.
  void read(const RunChunk& chunk, const VisibilityTable& visibility);

  /// The voxels of one side as rows of bits, in any type of unsigned integer.
  template <class Rows>
  struct SideRows {
    const Rows& opaque;
    const Rows& transparent;  // not read if there are no materials
    /// The materials of the transparent voxels, in the order of rows and bits. One material may
    /// stand for all of them. Empty if there are no transparent voxels.
    std::span<const Material> materials;
  };
  /// Replaces all six sides by known ones. Bits and rows lie along the axes of side_axes(), and the
  /// sides are in its order, the negative one first.
  template <class Rows>
  void keep(const RunChunk& chunk, const std::array<SideRows<Rows>, kDirectionCount>& sides);

  bool empty() const { return words_.empty(); }
  /// Returns true if extent and axis order are those of the chunk, and the borders are of a chunk
  /// of several materials.
  bool fits(const RunChunk& chunk) const {
    return !empty() && extent_ == chunk.extent && order_ == chunk.order;
  }
  /// Returns true if a side has transparent voxels.
  bool has_transparent(Direction side) const { return at(side).materials != 0; }
  /// Returns the axis along the bits of a side's rows.
  Axis bit_axis(Direction side) const { return at(side).bit_axis; }
  std::size_t row_words(Direction side) const { return at(side).row_words; }
  std::size_t row_count(Direction side) const { return at(side).row_count; }
  /// Returns the opaque voxels of a side, in rows of row_words() words, lowest bits first.
  const std::uint32_t* rows(Direction side) const { return words_.data() + at(side).first; }
  /// Returns the transparent voxels of a side in the same form. Requires has_transparent().
  const std::uint32_t* transparent_rows(Direction side) const {
    return rows(side) + row_words(side) * row_count(side);
  }
  /// Returns the materials of a side's transparent voxels, in the order of rows and bits; or a
  /// single material if all of them have it.
  std::span<const Material> transparent_materials(Direction side) const {
    return std::span(materials_).subspan(at(side).first_material, at(side).materials);
  }
  /// Returns the heap bytes allocated.
  std::size_t byte_size() const {
    return words_.capacity() * sizeof(std::uint32_t) + materials_.capacity() * sizeof(Material);
  }

 private:
  struct Side {
    Axis bit_axis{};
    std::uint8_t row_words = 0, row_count = 0;
    std::uint16_t first = 0;           // in words_
    std::uint32_t first_material = 0;  // in materials_
    std::uint16_t materials = 0;
  };
  const Side& at(Direction side) const { return sides_[static_cast<std::size_t>(side)]; }
  void begin(const RunChunk& chunk);
  template <class Row>
  void read_sides(const RunChunk& chunk, const VisibilityTable& visibility);
  /// Begins a side with its opaque and, if there are any, its transparent voxels. Their materials
  /// are appended to materials_ afterwards.
  template <class Rows>
  Side& begin_side(const RunChunk& chunk, Direction direction, Axis bit_axis, Axis row_axis,
                   const Rows& opaque, const Rows* transparent);
  /// Ends a side. Keeps one material if all are equal.
  void end_side(Side& side);

  std::vector<std::uint32_t> words_;  // of each side: the opaque rows, then the transparent ones
  std::vector<Material> materials_;
  Extent extent_;
  AxisOrder order_{};
  std::array<Side, kDirectionCount> sides_;
};

}  // namespace runstone
