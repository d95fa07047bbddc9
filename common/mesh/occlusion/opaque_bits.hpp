// OpaqueBits: the opaque voxels of a chunk and of the layer around it, one bit a voxel. They darken
// the corners of quads (quad_occlusion.hpp). One bit a voxel is no dense expansion.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The chunks around a chunk, in any axis order. Missing ones are null, and their voxels count as
/// empty.
using ChunksAround = std::array<const RunChunk*, 27>;

/// Returns the place in ChunksAround of the chunk at an offset of -1, 0 or 1 along each axis. Place
/// 13 belongs to the chunk itself and is not read.
constexpr std::size_t around_place(int x, int y, int z) {
  return static_cast<std::size_t>((x + 1) + 3 * (y + 1) + 9 * (z + 1));
}

class OpaqueBits {
 public:
  /// Reads a chunk and one layer of voxels around it. Requires valid chunks. A chunk around has the
  /// chunk's side along each axis along which its offset is 0. Allocates only to grow. Cost:
  ///   - O(runs + lines of the chunk);
  ///   - O(runs) of each of the six chunks that touch a side;
  ///   - O(voxels of the edge * log runs) of each of the twelve chunks at the edges.
  void read(const RunChunk& chunk, const ChunksAround& around, const VisibilityTable& visibility);

  /// Returns the number of the bit of a voxel: -1 .. side along each axis.
  std::uint32_t place(int x, int y, int z) const {
    return static_cast<std::uint32_t>(x + 1) * steps_[0] +
           static_cast<std::uint32_t>(y + 1) * steps_[1] +
           static_cast<std::uint32_t>(z + 1) * steps_[2];
  }
  /// Returns the difference between the numbers of neighbouring voxels along an axis.
  std::uint32_t step(Axis axis) const { return steps_[static_cast<std::size_t>(axis)]; }
  /// Returns 1 for an opaque voxel and 0 for any other.
  unsigned at(std::uint32_t place) const {
    return static_cast<unsigned>(words_[place / 64] >> (place % 64) & 1);
  }

 private:
  using Place3 = std::array<int, 3>;

  void read_inside(const RunChunk& chunk, const VisibilityTable& visibility);
  /// Reads the voxels [min, max) of one of the chunks around. The bounds are coordinates in the
  /// chunk in the middle.
  void read_beyond(const RunChunk& beyond, const Place3& offset, const VisibilityTable& visibility);
  template <class Row>
  void read_side(const RunChunk& beyond, const Place3& offset, std::size_t axis,
                 const VisibilityTable& visibility);
  void set(std::uint32_t place) { words_[place / 64] |= std::uint64_t{1} << (place % 64); }
  void set_range(std::uint32_t place, std::uint32_t count);
  /// Sets the bits of a row of at most 64 voxels, which lie `step` apart.
  void set_row(std::uint32_t place, std::uint32_t step, std::uint64_t row);

  std::vector<std::uint64_t> words_;
  std::array<std::uint32_t, 3> steps_{};  // by Axis
  std::array<int, 3> sides_{};            // of the chunk
  std::array<Axis, 3> axes_{};            // of the chunk: fastest, middle, slowest
};

}  // namespace runstone
