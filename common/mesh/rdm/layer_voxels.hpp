// LayerVoxels: one layer of a chunk, decoded (thesis 9.1, single layer decompression): its materials, and by
// row which voxels are opaque and which transparent. What remeshing a few layers needs, and the most that may
// be expanded. Internal to rdm.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/mesh/rdm/bit_row.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::rdm {

template <class Row>
struct LayerVoxels {
  /// Room before the first voxel and behind the last one, so that whole vectors may be compared with the
  /// voxel below.
  static constexpr std::size_t kRoom = 64;
  std::vector<Material> slots;  // row after row, of as many voxels as a row has bits, after kRoom others
  std::array<Row, kRowBits<Row>> opaque, clear;
  const Material* voxels() const { return slots.data() + kRoom; }
  Material* voxels() { return slots.data() + kRoom; }
  void resize(std::size_t count) {
    if (slots.size() < count + 2 * kRoom) slots.resize(count + 2 * kRoom);
  }
};

/// Decodes the layers `axis` = at[i] into *out[i], i < count; `at` ascends. Bits and rows lie as in the
/// sweep: bits run along the lower of the two other axes in the chunk's order. O(runs of the layers + a
/// search a row); for the fastest axis O(runs) once for all of them.
template <class Row>
void decode_layers(const RunChunk& chunk, Axis axis, const std::uint32_t* at, LayerVoxels<Row>* const* out,
                   std::size_t count, const VisibilityTable& visibility);

/// Decodes the layer `axis` = at of a chunk in any axis order, bits along `bit_axis`. A null chunk is empty:
/// `rows` rows of `bits` voxels.
template <class Row>
void decode_border(const RunChunk* chunk, Axis axis, std::uint32_t at, Axis bit_axis, std::uint32_t bits,
                   std::uint32_t rows, const VisibilityTable& visibility, LayerVoxels<Row>& out);

}  // namespace runstone::rdm
