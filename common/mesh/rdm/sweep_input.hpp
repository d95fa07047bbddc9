// SweepInput: what a layer sweep reads: the chunk as coded runs, and what lies beyond its six sides. Internal to
// rdm.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/rdm/chunk_palette.hpp"
#include "common/mesh/rdm/quad_buckets.hpp"
#include "common/mesh/rdm/quad_shape.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/bit_row.hpp"

namespace runstone::rdm {

/// Covers [end of the run before it, end) of the flattened chunk.
struct PaletteRun {
  std::uint32_t end = 0;
  PaletteIndex index = 0;
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
/// Its place in arrays by Side.
constexpr std::size_t at(Side side) { return static_cast<std::size_t>(side); }
/// The sides that every layer touches, with one row of each border.
inline constexpr std::array<Side, 4> kLayerSides = {Side::mid_neg, Side::mid_pos, Side::fast_neg,
                                                    Side::fast_pos};

/// What lies beyond the chunk, by Side, as rows of bits.
/// Rows and bits: slow sides a row per middle coordinate and a bit per fast one; middle sides slow, fast;
/// fast sides slow, middle.
template <class Row>
struct Borders {
  using Rows = std::array<Row, kRowBits<Row>>;
  /// Voxels that hide any face of the chunk; for a chunk of one transparent material, those of it as well.
  std::array<Rows, 6> hiding;
  /// Voxels of a transparent material that the chunk has, too. Not set where `meets` is false.
  std::array<Rows, 6> transparent;
  /// Whether a side has such voxels; never in a chunk of one material.
  std::array<bool, 6> meets{};
  /// Their codes, a row behind the other; only if the chunk has more than one transparent material.
  std::array<std::vector<PaletteIndex>, 6> indices;
};

struct SweepInput {
  std::span<const PaletteRun> runs;
  OrderedExtent extent{};
  const ChunkPalette* palette = nullptr;
  std::array<Direction, 6> direction{};  // by Side
  std::array<QuadShape, 6> shape;        // by Side
  QuadBuckets* opaque = nullptr;
  QuadBuckets* transparent = nullptr;
  bool chunk_sides = false;  // whether SweepState::chunk_sides is wanted
};

}  // namespace runstone::rdm
