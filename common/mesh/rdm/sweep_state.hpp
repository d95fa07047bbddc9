// SweepState: what a layer sweep writes and reads again: two layers as codes and as rows of bits, the strips
// that are open, and the chunk's own sides. Kept between sweeps, so that none allocates. Internal to rdm.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/mesh/quad.hpp"
#include "common/mesh/rdm/chunk_palette.hpp"
#include "common/runs/bit_row.hpp"
#include "common/runs/extent.hpp"

namespace runstone::rdm {

/// Rows of one layer, with room before and behind for steps of whole vectors.
template <class Row>
struct alignas(64) LayerRows {
  static constexpr std::size_t kBefore = 64 / sizeof(Row);
  static constexpr std::size_t kBehind = 64 / sizeof(Row);
  std::array<Row, kBefore + kRowBits<Row> + kBehind> slots{};
  Row* data() { return slots.data() + kBefore; }
  const Row* data() const { return slots.data() + kBefore; }
};

/// The codes of one layer, line behind line, with room before and behind for whole rows and vectors.
template <class Row, class Index>
struct LayerIndices {
  static constexpr std::size_t kRoom =
      kSideMax;  // the line before the first one is read, and a row behind
  alignas(64) std::array<Index, kRoom + std::size_t{kRowBits<Row>} * kRowBits<Row> + kRoom> slots{};
  Index* data() { return slots.data() + kRoom; }
};

/// Which of the two layers in SweepState is the one at hand, and which the one before it.
struct LayerPair {
  unsigned current = 0, previous = 1;
};

template <class Row>
struct SweepState {
  using Rows = LayerRows<Row>;
  template <class Index>
  using Indices = std::array<LayerIndices<Row, Index>, 2>;
  static constexpr std::size_t kPlaces = std::size_t{kRowBits<Row>} * kRowBits<Row>;  // rows * bits
  static_assert(kPlaces <= 1u << 16 &&
                kSideMax <= 1u << 8);  // places and layers as they are kept here

  // What LayerBuilder makes. Where there are two of a thing, they are by ring.
  Indices<BytePaletteIndex> byte_indices;
  std::unique_ptr<Indices<PaletteIndex>>
      full_indices;           // made for the first chunk whose codes do not fit bytes
  std::array<Rows, 2> solid;  // voxels with faces
  std::array<Rows, 2>
      hiding;        // voxels that hide a face, with the middle neighbours' in the slots around
  Rows transparent;  // of the layer at hand
  std::array<Rows, 2> cut_fast,
      cut_mid;  // where the material differs from the voxel before, along an axis
  Rows cut_slow;

  /// Voxels whose face shows, by Side; slow sides lie between two layers and use the first ring only.
  std::array<std::array<Rows, 2>, 6> face;

  // What StripTracer makes of one side of a layer: strips that end and begin, by row.
  Rows closing, opening,
      start;            // last bits of strips that close and that open; first bits of strips
  Rows joins_previous;  // of upright strips: bits that close in the row before as well
  /// Places of bits that close and open, row * kRowBits + bit, with room for a step behind.
  std::array<std::uint16_t, kPlaces + 4> closed, opened;
  // And what it keeps from row to row, or layer to layer.
  /// Quads that are open, by Side; then by end of the strip (slow), or by row and end (middle).
  std::array<std::array<Quad, kPlaces>, 4> open;
  /// Layer in which a face across the fastest axis appeared: negative and positive side, then row and bit.
  std::array<std::array<std::uint8_t, kPlaces>, 2> start_layer;

  // What ChunkSides makes, by Side.
  std::array<std::array<Row, kRowBits<Row>>, 6>
      chunk_sides;                        // opaque voxels, laid out as in Borders
  std::array<bool, 6> sides_transparent;  // whether there are transparent ones

  /// The codes in the form Index. Allocates for the first chunk that needs whole ones.
  template <class Index>
  Indices<Index>& indices() {
    if constexpr (sizeof(Index) == 1) {
      return byte_indices;
    } else {
      if (!full_indices) full_indices = std::make_unique<Indices<PaletteIndex>>();
      return *full_indices;
    }
  }
};

}  // namespace runstone::rdm
