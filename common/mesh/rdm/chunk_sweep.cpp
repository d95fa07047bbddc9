#include "common/mesh/rdm/chunk_sweep.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>

#include "common/mesh/rdm/border_reader.hpp"
#include "common/mesh/rdm/index_runs.hpp"
#include "common/mesh/rdm/layer_sweep.hpp"
#include "common/mesh/rdm/quad_shape.hpp"
#include "common/mesh/rdm/side_axes.hpp"

namespace runstone::rdm {
namespace {

using Scratch = RdmScratch::State;

/// Keeps the chunk's own sides, which the sweep has found.
template <class Row>
void keep_borders(const RunChunk& chunk, const ChunkPalette& palette, const SweepState<Row>& sweep,
                  ChunkBorders& out) {
  using Rows = std::array<Row, kRowBits<Row>>;
  static constexpr Rows kNone{};
  const auto axes = side_axes(chunk.order);
  const bool single_transparent = palette.solid_count() == 1 && palette.has_transparent();
  const auto side = [&](std::size_t i) -> ChunkBorders::SideRows<Rows> {
    const ChunkSide<Row>& found = sweep.chunk_sides[i];
    std::span<const Material> materials;
    if (single_transparent) {
      // The sweep took this material for an opaque one.
      const std::uint32_t rows = side_of(chunk, axes[i / 2].row);
      if (std::any_of(found.opaque.begin(), found.opaque.begin() + rows,
                      [](Row r) { return r != 0; }))
        materials = palette.transparent();
      return {kNone, found.opaque, materials};
    }
    if (found.has_transparent)
      materials = palette.transparent_count() == 1 ? palette.transparent() : found.materials;
    return {found.opaque, found.transparent, materials};
  };
  out.keep<Rows>(chunk, {side(0), side(1), side(2), side(3), side(4), side(5)});
}

/// Returns the rows of a side's border that the sweep of a part reads.
template <class Row>
RowRange rows_read(const SweepPart<Row>& part, const OrderedExtent& e, Side side) {
  const RowRange along_slow = {part.first_read(), part.read_end(e)};
  const Row traced = part.traced[at(side)];
  const auto if_traced = [&](std::uint32_t layer) {
    return (traced >> layer & 1) != 0 ? along_slow : RowRange{};
  };
  switch (side) {
    case Side::slow_neg:
      return part.begin == 0 ? RowRange{0, e.m} : RowRange{};
    case Side::slow_pos:
      return part.end == e.s ? RowRange{0, e.m} : RowRange{};
    case Side::mid_pos:
      return if_traced(e.m - 1);
    case Side::fast_pos:
      return if_traced(e.f - 1);
    default:
      return if_traced(0);
  }
}

}  // namespace

IndexedRuns index_runs(const RunChunk& chunk, RunRange range, const VisibilityTable& visibility,
                       Scratch& scratch) {
  ChunkPalette& palette = scratch.palette;
  palette.clear();
  const std::size_t size = range.count();
  return chunk.runs.visit([&](const auto& all) -> IndexedRuns {
    const auto runs = all.part(range.first, size);
    const auto list_plainly = [&](auto& indices) {
      indices.resize(size);
      palette.list(runs, 0, size, visibility, indices.data());
    };
    if (scratch.plain) {
      list_plainly(scratch.byte_indices);
    } else {
      scratch.byte_indices.resize(size);
      index_runs(runs, visibility, palette, scratch.byte_indices.data());
    }
    if (!palette.fit_bytes()) {
      list_plainly(scratch.full_indices);
      return {runs, nullptr, scratch.full_indices.data()};
    }
    // A single transparent material is meshed as a single opaque one.
    if (palette.solid_count() == 1 && palette.has_transparent()) {
      for (BytePaletteIndex& index : scratch.byte_indices) index = index != 0 ? 1 : 0;
    }
    return {runs, scratch.byte_indices.data(), nullptr};
  });
}

template <class Row>
void sweep_chunk(const SweepRequest& request, const IndexedRuns& runs, const SweepPart<Row>& part,
                 Scratch& scratch, RowScratch<Row>& rows) {
  const RunChunk& chunk = request.chunk;
  const auto axes = side_axes(chunk.order);
  const auto strips = strip_axes(chunk.order);
  SweepInput input;
  input.runs = runs;
  input.extent = ordered(chunk.extent, chunk.order);
  input.palette = &scratch.palette;
  input.opaque = &scratch.opaque;
  input.transparent = &scratch.transparent;
  input.chunk_sides = request.chunk_borders != nullptr;
  for (std::size_t i = 0; i < kDirectionCount; ++i) {
    const auto side = static_cast<Side>(i);
    const SideAxes& a = axes[i / 2];
    const Direction direction = direction_of(a.layer, i % 2 != 0);
    input.direction[i] = direction;
    input.shape[i] = QuadShape(direction, strips[i / 2].strip, strips[i / 2].row);
    const auto d = static_cast<std::size_t>(direction);
    read_border({chunk, direction, request.neighbours[d], request.borders[d], a, side},
                rows_read(part, input.extent, side), request.visibility, scratch, rows.borders);
  }
  if constexpr (!std::is_same_v<Row, Row32>) {
    if (scratch.plain) sweep_layers_plain(input, rows.borders, part, rows.sweep);
  }
  if (!scratch.plain) sweep_layers(input, rows.borders, part, rows.sweep);
  if (request.chunk_borders != nullptr) {
    keep_borders(chunk, scratch.palette, rows.sweep, *request.chunk_borders);
  }
}
template void sweep_chunk(const SweepRequest&, const IndexedRuns&, const SweepPart<Row32>&,
                          Scratch&, RowScratch<Row32>&);
template void sweep_chunk(const SweepRequest&, const IndexedRuns&, const SweepPart<Row64>&,
                          Scratch&, RowScratch<Row64>&);
template void sweep_chunk(const SweepRequest&, const IndexedRuns&, const SweepPart<Row128>&,
                          Scratch&, RowScratch<Row128>&);

}  // namespace runstone::rdm
