// The layer sweep: meshes a chunk in one pass over the layers of its slowest axis. Only two layers are ever
// there, as codes made from the runs that lie in them, and as rows of bits (one row per line, one bit per
// voxel). Internal to rdm; docs/meshing.md draws it.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/mesh/rdm/bit_row.hpp"
#include "common/mesh/rdm/material_codes.hpp"
#include "common/mesh/rdm/quad_buckets.hpp"
#include "common/mesh/rdm/quad_shape.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone::rdm {

/// Covers [end of the run before it, end) of the flattened chunk.
struct CodedRun {
  std::uint32_t end = 0;
  Code code = 0;
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
  std::array<std::vector<Code>, 6> codes;
};

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
template <class Row, class C>
struct LayerCodes {
  static constexpr std::size_t kRoom = 128;
  alignas(64) std::array<C, kRoom + std::size_t{kRowBits<Row>} * kRowBits<Row> + kRoom> slots{};
  C* data() { return slots.data() + kRoom; }
};

template <class Row>
struct SweepState {
  using Rows = LayerRows<Row>;
  template <class C>
  using Codes = std::array<LayerCodes<Row, C>, 2>;
  // Two layers each, the one at hand and the one before it.
  Codes<ByteCode> byte_codes;
  std::unique_ptr<Codes<Code>> whole_codes;  // made for the first chunk whose codes do not fit bytes
  std::array<Rows, 2> solid;                 // voxels with faces
  std::array<Rows, 2> hiding;  // voxels that hide a face, with the middle neighbours' in the slots around
  Rows transparent;            // of the layer at hand
  std::array<Rows, 2> cut_fast, cut_mid;  // where the material differs from the voxel before, along an axis
  Rows cut_slow;
  std::array<std::array<Rows, 2>, 6> face;  // voxels whose face shows, by side
  /// Opaque voxels of the chunk's own six sides, as Borders has them; filled if SweepInput asks for them.
  std::array<std::array<Row, kRowBits<Row>>, 6> own_sides;
  std::array<bool, 6> own_transparent;  // whether there are transparent ones among them
  std::array<Rows, 3> strips;           // of a side in which most rows change, made for all its rows at once
  /// Quads that are open, by side; then by end of the strip (slow), or by row and end (middle).
  std::array<std::array<Quad, std::size_t{kRowBits<Row>} * kRowBits<Row>>, 4> open;
  /// Places of bits that close and open in one side of a layer, with room for a step behind.
  std::array<std::uint16_t, std::size_t{kRowBits<Row>} * kRowBits<Row> + 4> closed, opened;
  /// Layer in which a face across the fastest axis appeared, by side, row and bit.
  std::array<std::array<std::uint8_t, std::size_t{kRowBits<Row>} * kRowBits<Row>>, 2> born;
};

struct SweepInput {
  std::span<const CodedRun> runs;
  OrderedExtent extent{};
  const MaterialCodes* codes = nullptr;
  std::array<Direction, 6> direction{};  // by Side
  std::array<QuadShape, 6> shape;        // by Side
  QuadBuckets* opaque = nullptr;
  QuadBuckets* transparent = nullptr;
  bool own_sides = false;  // whether SweepState::own_sides is wanted
};

/// Puts the quads of the chunk into the buckets. Requires sides up to kRowBits<Row>, runs that tile the
/// extent and at least one material that is not empty. By the best instructions the machine has.
void sweep_layers(const SweepInput& input, const Borders<Row64>& borders, SweepState<Row64>& state);
void sweep_layers(const SweepInput& input, const Borders<Row128>& borders, SweepState<Row128>& state);

/// The same, a row at a time: the plain path that the others must agree with.
void sweep_layers_plain(const SweepInput& input, const Borders<Row64>& borders, SweepState<Row64>& state);

}  // namespace runstone::rdm
