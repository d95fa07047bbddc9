#include "common/mesh/rdm/layer_voxels.hpp"

#include <algorithm>

#include "common/mesh/rdm/divider.hpp"
#include "common/runs/layer.hpp"
#include "common/runs/layer_walk.hpp"

namespace runstone::rdm {
namespace {

template <class Row>
class Decoder {
 public:
  Decoder(OrderedExtent e, const VisibilityTable& visibility) : e_(e), visibility_(visibility.data()) {}

  void clear(LayerVoxels<Row>& out, std::uint32_t bits, std::uint32_t rows) const {
    out.resize(std::size_t{bits} * rows);
    std::fill_n(out.opaque.begin(), rows, Row{0});
    std::fill_n(out.clear.begin(), rows, Row{0});
  }
  void stretch(LayerVoxels<Row>& out, std::uint32_t bits, std::uint32_t row, std::uint32_t first,
               std::uint32_t last, Material material) const {
    std::fill_n(out.voxels() + std::size_t{row} * bits + first, last - first, material);
    const Visibility visibility = visibility_[material];
    if (visibility == Visibility::empty) return;
    const Row mask = bits_below<Row>(last - first) << first;
    (visibility == Visibility::opaque ? out.opaque : out.clear)[row] |= mask;
  }

  /// Layers of the fastest axis: a bit per line of the chunk. Most runs lie between the layers asked for.
  template <class Runs>
  void fast_layers(const Runs& runs, const std::uint32_t* at, LayerVoxels<Row>* const* out,
                   std::size_t count) const {
    const Divider line_of(e_.f);
    const Divider row_of(e_.m);
    const std::uint32_t low = at[0];
    const std::uint32_t high = at[count - 1];
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::uint32_t end = runs.end(i);
      const std::uint32_t line = line_of(begin);
      const std::uint32_t from = begin - line * e_.f;  // in the line where the run begins
      const std::uint32_t to = end - line * e_.f;
      begin = end;
      if (to <= low || (from > high && to <= e_.f + low)) continue;
      const Material material = runs.material(i);
      for (std::size_t j = 0; j < count; ++j) {
        std::uint32_t first = line + (from > at[j] ? 1 : 0);  // lines whose voxel at[j] the run covers
        const std::uint32_t last = line + line_of(to + e_.f - 1 - at[j]);
        while (first < last) {
          const std::uint32_t row = row_of(first);
          const std::uint32_t bit = first - row * e_.m;
          const std::uint32_t stop = std::min(e_.m, bit + last - first);
          stretch(*out[j], e_.m, row, bit, stop, material);
          first += stop - bit;
        }
      }
    }
  }

 private:
  const OrderedExtent e_;
  const Visibility* const visibility_;
};

}  // namespace

template <class Row>
void decode_layers(const RunChunk& chunk, Axis axis, const std::uint32_t* at, LayerVoxels<Row>* const* out,
                   std::size_t count, const VisibilityTable& visibility) {
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  const int rank = rank_of(axis, chunk.order);
  const std::uint32_t bits = rank == 0 ? e.m : e.f;
  const Decoder<Row> decoder(e, visibility);
  for (std::size_t i = 0; i < count; ++i) decoder.clear(*out[i], bits, rank == 2 ? e.m : e.s);
  chunk.runs.visit([&](const auto& runs) {
    if (rank == 0) return decoder.fast_layers(runs, at, out, count);
    for (std::size_t i = 0; i < count; ++i) {
      walk_layer(runs, e, rank, at[i],
                 [&](std::uint32_t row, std::uint32_t first, std::uint32_t last, Material material) {
                   decoder.stretch(*out[i], bits, row, first, last, material);
                 });
    }
  });
}

template <class Row>
void decode_border(const RunChunk* chunk, Axis axis, std::uint32_t at, Axis bit_axis, std::uint32_t bits,
                   std::uint32_t rows, const VisibilityTable& visibility, LayerVoxels<Row>& out) {
  const Decoder<Row> decoder({}, visibility);
  decoder.clear(out, bits, rows);
  const std::size_t count = std::size_t{bits} * rows;
  if (chunk == nullptr) {
    std::fill_n(out.voxels(), count, kEmpty);
    return;
  }
  read_layer(*chunk, axis, at, bit_axis, std::span(out.voxels(), count));
  const Material* voxel = out.voxels();
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t bit = 0; bit < bits; ++bit, ++voxel) {
      const Visibility seen = visibility[*voxel];
      out.opaque[row] |= Row{seen == Visibility::opaque} << bit;
      out.clear[row] |= Row{seen == Visibility::transparent} << bit;
    }
  }
}

template void decode_layers(const RunChunk&, Axis, const std::uint32_t*, LayerVoxels<Row64>* const*,
                            std::size_t, const VisibilityTable&);
template void decode_layers(const RunChunk&, Axis, const std::uint32_t*, LayerVoxels<Row128>* const*,
                            std::size_t, const VisibilityTable&);
template void decode_border(const RunChunk*, Axis, std::uint32_t, Axis, std::uint32_t, std::uint32_t,
                            const VisibilityTable&, LayerVoxels<Row64>&);
template void decode_border(const RunChunk*, Axis, std::uint32_t, Axis, std::uint32_t, std::uint32_t,
                            const VisibilityTable&, LayerVoxels<Row128>&);

}  // namespace runstone::rdm
