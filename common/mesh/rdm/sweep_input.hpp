// SweepInput: the input of a layer sweep: the chunk as runs of palette indices, and the voxels
// beyond its six sides. Internal to rdm.
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "common/mesh/rdm/chunk_palette.hpp"
#include "common/mesh/rdm/quad_buckets.hpp"
#include "common/mesh/rdm/quad_shape.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/bit_row.hpp"
#include "common/runs/run_list.hpp"

namespace runstone::rdm {

/// Gives the end and the palette index of each run of a chunk, or of some of its runs. The ends are
/// read from the chunk's list of runs.
class IndexedRuns {
 public:
  IndexedRuns() = default;
  /// Runs is NarrowRuns or WideRuns. The runs and the indices must stay in place. `full` is null if
  /// the indices are bytes.
  template <class Runs>
  IndexedRuns(const Runs& runs, const BytePaletteIndex* bytes, const PaletteIndex* full)
      : size_(runs.size()), bytes_(bytes), full_(full) {
    static_assert(std::endian::native == std::endian::little);
    if constexpr (std::is_same_v<Runs, NarrowRuns>) {
      words_ = reinterpret_cast<const std::byte*>(runs.packed().data());
      mask_ = 0xffff;
    } else {
      words_ = reinterpret_cast<const std::byte*>(runs.ends().data());
      mask_ = 0xffffffff;
    }
  }
  std::size_t size() const { return size_; }
  /// Both forms of a list have a word of 32 bits a run, whose lowest bits are the end.
  std::uint32_t end(std::size_t run) const {
    std::uint32_t word;
    std::memcpy(&word, words_ + 4 * run, sizeof word);
    return word & mask_;
  }
  /// Returns the index in the type Index. Requires that type's indices.
  template <class Index>
  Index index(std::size_t run) const {
    if constexpr (sizeof(Index) == 1) {
      return bytes_[run];
    } else {
      return full_[run];
    }
  }

 private:
  const std::byte* words_ = nullptr;
  std::uint32_t mask_ = 0;
  std::size_t size_ = 0;
  const BytePaletteIndex* bytes_ = nullptr;
  const PaletteIndex* full_ = nullptr;
};

/// A side of the chunk by the rank of its axis: slow, middle, fast; negative before positive.
enum class Side : std::uint8_t {
  slow_neg = 0,
  slow_pos = 1,
  mid_neg = 2,
  mid_pos = 3,
  fast_neg = 4,
  fast_pos = 5
};
/// Returns its place in arrays by Side.
constexpr std::size_t at(Side side) { return static_cast<std::size_t>(side); }
/// The sides that every layer touches, with one row of each border.
inline constexpr std::array<Side, 4> kLayerSides = {Side::mid_neg, Side::mid_pos, Side::fast_neg,
                                                    Side::fast_pos};

/// The voxels beyond the chunk, by Side, as rows of bits.
///   - slow sides: a row per middle coordinate, a bit per fast coordinate;
///   - middle sides: a row per slow coordinate, a bit per fast coordinate;
///   - fast sides: a row per slow coordinate, a bit per middle coordinate.
template <class Row>
struct Borders {
  using Rows = std::array<Row, kRowBits<Row>>;
  /// Voxels that hide any face of the chunk. For a chunk of one transparent material, voxels of
  /// that material count too.
  std::array<Rows, 6> hiding;
  /// Voxels of a transparent material that the chunk has too. The rows of a side are set only if
  /// its `meets` is true.
  std::array<Rows, 6> transparent;
  /// True if a side has such voxels. Always false for a chunk of one material.
  std::array<bool, 6> meets{};
  /// One palette index for each voxel of the side, row by row; or a single index if all voxels of
  /// `transparent` have it. Empty unless the chunk has more than one transparent material.
  std::array<std::vector<PaletteIndex>, 6> indices;
};

struct SweepInput {
  IndexedRuns runs;
  OrderedExtent extent{};
  const ChunkPalette* palette = nullptr;
  std::array<Direction, 6> direction{};  // by Side
  std::array<QuadShape, 6> shape;        // by Side
  QuadBuckets* opaque = nullptr;
  QuadBuckets* transparent = nullptr;
  bool chunk_sides = false;  // true if SweepState::chunk_sides are needed
};

}  // namespace runstone::rdm
