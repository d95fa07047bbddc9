#include "common/mesh/rdm/border_reader.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/border_rows.hpp"
#include "common/runs/layer.hpp"

namespace runstone::rdm {
namespace {

using Scratch = RdmScratch::State;

/// Copies rows of bits that a neighbour's borders keep, in the chunk's orientation.
template <class Rows>
void copy_rows(const ChunkBorders& kept, Direction side, const std::uint32_t* from, Axis bit_axis,
               Rows& out) {
  using Row = typename Rows::value_type;
  const std::size_t words = kept.row_words(side);
  const std::size_t count = kept.row_count(side);
  if (words == 1) {
    std::copy_n(from, count, out.begin());
  } else if constexpr (sizeof(Row) > sizeof(*from)) {
    for (std::size_t r = 0; r < count; ++r) {
      Row row = 0;
      for (std::size_t w = words; w != 0; --w) row = row << 32 | from[w - 1];
      from += words;
      out[r] = row;
    }
  }
  if (kept.bit_axis(side) == bit_axis) return;
  std::fill(out.begin() + static_cast<std::ptrdiff_t>(count), out.end(), Row{0});
  transpose(out);
}

/// Finds the voxels of a kept side, of several transparent materials, whose material the chunk has.
template <class Row>
void find_known(const ChunkBorders& kept, Direction side, Axis bit_axis, std::size_t bits,
                std::size_t row_count, const ChunkPalette& palette, std::size_t at,
                Borders<Row>& borders) {
  auto& known = borders.transparent[at];
  known.fill(0);
  const bool is_turned = kept.bit_axis(side) != bit_axis;
  const std::size_t words = kept.row_words(side), rows = kept.row_count(side);
  auto& indices = borders.indices[at];
  if (palette.transparent_count() > 1) indices.resize(bits * row_count);
  const std::uint32_t* word = kept.transparent_rows(side);
  const Material* material = kept.transparent_materials(side).data();
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t w = 0; w < words; ++w, ++word) {
      for (std::uint32_t left = *word; left != 0; left &= left - 1) {
        const PaletteIndex index = palette.transparent_index(*material++);
        if (index == 0) continue;
        const std::size_t bit = 32 * w + lowest_bit(Row64{left});
        const std::size_t row_at = is_turned ? bit : r, bit_at = is_turned ? r : bit;
        known[row_at] |= Row{1} << bit_at;
        if (!indices.empty()) indices[row_at * bits + bit_at] = index;
      }
    }
  }
}

/// Reads a border where transparent voxels may meet: the chunk has transparent materials among
/// others, and the neighbour may have them too.
template <class Row>
void read_mixed_border(const RunChunk& neighbour, const LayerPlace& place, RowRange wanted,
                       const VisibilityTable& visibility, Scratch& scratch, std::size_t at,
                       Borders<Row>& borders) {
  const ChunkPalette& palette = scratch.palette;
  const auto class_of = [&palette, &visibility](Material material) -> PaletteIndex {
    return palette.transparent_index(material) != 0     ? 2
           : visibility[material] == Visibility::opaque ? 1
                                                        : 0;
  };
  const std::uint32_t rows = side_of(neighbour, place.row_axis());
  const std::uint32_t bits = side_of(neighbour, place.bit_axis);
  auto& voxels = scratch.border_voxels;
  const auto read_voxels = [&] {
    voxels.resize(std::size_t{bits} * rows);
    read_layer(neighbour, place.axis, place.at, place.bit_axis, voxels);
  };
  std::array<typename Borders<Row>::Rows, 2> planes;
  // With many short runs, reading each voxel of the layer costs less than reading each run of the
  // chunk.
  const bool dense = wanted.count() == rows && neighbour.runs.size() > std::size_t{4} * bits * rows;
  if (dense) {
    read_voxels();
    const Material* voxel = voxels.data();
    for (auto& plane : planes) plane.fill(0);
    for (std::uint32_t r = 0; r < rows; ++r) {
      for (std::uint32_t bit = 0; bit < bits; ++bit, ++voxel) {
        const PaletteIndex of = class_of(*voxel);
        planes[0][r] |= Row{of & 1} << bit;
        planes[1][r] |= Row{of >> 1} << bit;
      }
    }
  } else {
    read_layer_rows(neighbour, place, wanted, planes, class_of);
  }
  borders.hiding[at] = planes[0];
  borders.transparent[at] = planes[1];
  std::size_t known = 0;
  for (const Row row : planes[1]) known += bit_count(row);
  borders.meets[at] = known != 0;
  if (known == 0 || palette.transparent_count() == 1) return;
  // A few voxels are looked up one by one.
  constexpr std::size_t kLookupsMax = 128;
  const bool looks_up = !dense && known <= kLookupsMax;
  if (!dense && !looks_up) read_voxels();
  auto& indices = borders.indices[at];
  indices.resize(std::size_t{bits} * rows);
  for (std::uint32_t r = 0; r < rows; ++r) {
    for (Row left = planes[1][r]; left != 0; left &= left - 1) {
      const std::uint32_t bit = lowest_bit(left);
      const std::size_t i = std::size_t{r} * bits + bit;
      indices[i] = palette.transparent_index(looks_up ? material_at(neighbour, place.voxel(bit, r))
                                                      : voxels[i]);
    }
  }
}

/// Does what read_border() does from the borders that the neighbour's holder keeps.
template <class Row>
void use_kept_border(const ChunkBorders& kept, Direction touching, const LayerPlace& place,
                     std::uint32_t bits, std::uint32_t rows, const ChunkPalette& palette,
                     std::size_t at, Borders<Row>& borders) {
  auto& hiding = borders.hiding[at];
  copy_rows(kept, touching, kept.rows(touching), place.bit_axis, hiding);
  if (!palette.has_transparent() || !kept.has_transparent(touching)) return;
  auto& known = borders.transparent[at];
  const auto materials = kept.transparent_materials(touching);
  if (materials.size() == 1) {
    const PaletteIndex index = palette.transparent_index(materials.front());
    if (index == 0) return;
    copy_rows(kept, touching, kept.transparent_rows(touching), place.bit_axis, known);
    if (palette.transparent_count() > 1) borders.indices[at].assign(1, index);
  } else {
    find_known(kept, touching, place.bit_axis, bits, rows, palette, at, borders);
  }
  if (palette.solid_count() == 1) {
    // A single transparent material is meshed as a single opaque one.
    std::transform(hiding.begin(), hiding.end(), known.begin(), hiding.begin(), std::bit_or<>());
  } else {
    borders.meets[at] = std::any_of(known.begin(), known.end(), [](Row row) { return row != 0; });
  }
}

template <class Row>
void read_side(const BorderPlace& at_side, RowRange wanted, const VisibilityTable& visibility,
               Scratch& scratch, Borders<Row>& borders) {
  const auto& [chunk, direction, neighbour, kept, axes, side] = at_side;
  const std::size_t at = rdm::at(side);
  const ChunkPalette& palette = scratch.palette;
  auto& hiding = borders.hiding[at];
  borders.meets[at] = false;
  borders.indices[at].clear();
  if (neighbour == nullptr || wanted.count() == 0) {
    hiding.fill(0);
    return;
  }
  RUNSTONE_ASSERT(side_of(*neighbour, axes.bit) == side_of(chunk, axes.bit) &&
                  side_of(*neighbour, axes.row) == side_of(chunk, axes.row));
  const std::uint32_t layer = is_positive(direction) ? 0 : side_of(*neighbour, axes.layer) - 1;
  const LayerPlace place{axes.layer, axes.bit, layer};
  if (kept != nullptr && !neighbour->is_uniform()) {
    RUNSTONE_ASSERT(kept->fits(*neighbour));
    return use_kept_border(*kept, opposite(direction), place, side_of(chunk, axes.bit),
                           side_of(chunk, axes.row), palette, at, borders);
  }
  std::array<typename Borders<Row>::Rows, 1> plane;
  if (!palette.has_transparent()) {
    read_layer_rows(*neighbour, place, wanted, plane,
                    [table = visibility.data()](Material material) -> PaletteIndex {
                      return table[material] == Visibility::opaque ? 1 : 0;
                    });
    hiding = plane[0];
    return;
  }
  if (palette.solid_count() == 1) {
    read_layer_rows(
        *neighbour, place, wanted, plane,
        [table = visibility.data(), single = palette.single()](Material material) -> PaletteIndex {
          return table[material] == Visibility::opaque || material == single ? 1 : 0;
        });
    hiding = plane[0];
    return;
  }
  read_mixed_border(*neighbour, place, wanted, visibility, scratch, at, borders);
}

}  // namespace

// The code is in a function of this file alone, so that the compiler inlines the readers into it.
template <class Row>
void read_border(const BorderPlace& at_side, RowRange wanted, const VisibilityTable& visibility,
                 Scratch& scratch, Borders<Row>& borders) {
  read_side(at_side, wanted, visibility, scratch, borders);
}
template void read_border(const BorderPlace&, RowRange, const VisibilityTable&, Scratch&,
                          Borders<Row32>&);
template void read_border(const BorderPlace&, RowRange, const VisibilityTable&, Scratch&,
                          Borders<Row64>&);
template void read_border(const BorderPlace&, RowRange, const VisibilityTable&, Scratch&,
                          Borders<Row128>&);

}  // namespace runstone::rdm
