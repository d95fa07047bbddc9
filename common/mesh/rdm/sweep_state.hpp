// SweepState: the state of a layer sweep: two layers as palette indices and as rows of bits, the
// open strips, and the chunk's own sides. It is kept between sweeps, so that a sweep does not
// allocate. Internal to rdm.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

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

/// The palette indices of one layer, line by line, with room before and behind for whole rows and
/// vectors.
template <class Row, class Index>
struct LayerIndices {
  // The line before the first one is read, and a row behind.
  static constexpr std::size_t kRoom = kSideMax;
  alignas(64) std::array<Index, kRoom + std::size_t{kRowBits<Row>} * kRowBits<Row> + kRoom> slots{};
  Index* data() { return slots.data() + kRoom; }
};

/// The slots of the current and of the previous layer in SweepState.
struct LayerPair {
  unsigned current = 0, previous = 1;
};

/// One of the six outermost layers of the chunk itself, laid out as in Borders.
template <class Row>
struct ChunkSide {
  std::array<Row, kRowBits<Row>> opaque{}, transparent{};
  bool has_transparent = false;  // `transparent` is set only if it is true
  /// The materials of the transparent voxels, by row and bit. Empty if the chunk has one of them.
  std::vector<Material> materials;
};

template <class Row>
struct SweepState {
  using Rows = LayerRows<Row>;
  template <class Index>
  using Indices = std::array<LayerIndices<Row, Index>, 2>;
  static constexpr std::size_t kPlaces = std::size_t{kRowBits<Row>} * kRowBits<Row>;  // rows * bits
  // Places and layers fit the types below.
  static_assert(kPlaces <= 1u << 16 && kSideMax <= 1u << 8);

  // The part that LayerBuilder writes. Pairs are indexed by slot.
  Indices<BytePaletteIndex> byte_indices;
  // Made for the first chunk whose indices do not fit into bytes.
  std::unique_ptr<Indices<PaletteIndex>> full_indices;
  std::array<Rows, 2> solid;  // voxels with faces
  // Voxels that hide a face. The rows before and behind are those of the middle neighbours.
  std::array<Rows, 2> hiding;
  Rows transparent;  // of the current layer
  // Places where the material differs from the previous voxel along an axis.
  std::array<Rows, 2> cut_fast, cut_mid;
  Rows cut_slow;

  /// Voxels whose face shows, by Side. Slow sides lie between two layers and use the first slot
  /// only.
  std::array<std::array<Rows, 2>, 6> face;

  // The part that StripTracer writes for one side of a layer: strips that end and begin, by row.
  // Last bits of strips that close and that open, and first bits of strips.
  Rows closing, opening, start;
  // Of a side across the fastest axis: bits that close, in the same material, in the previous row
  // as well.
  Rows joins_previous;
  /// Places of bits that close and open, row * kRowBits + bit, with room for a step behind.
  std::array<std::uint16_t, kPlaces + 4> closed, opened;
  // The part that StripTracer keeps from row to row, or from layer to layer.
  /// Open quads, by Side; then by end of the strip (slow), or by row and end (middle).
  std::array<std::array<Quad, kPlaces>, 4> open;
  /// The layer in which a face across the fastest axis appeared: by negative and positive side,
  /// then row and bit.
  std::array<std::array<std::uint8_t, kPlaces>, 2> start_layer;

  // The part that ChunkSides writes, by Side.
  std::array<ChunkSide<Row>, 6> chunk_sides;

  /// Returns the palette indices in the type Index. Allocates for the first chunk that needs full
  /// ones.
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
