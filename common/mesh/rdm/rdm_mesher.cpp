#include "common/mesh/rdm/rdm_mesher.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/border_rows.hpp"
#include "common/mesh/rdm/chunk_palette.hpp"
#include "common/mesh/rdm/index_runs.hpp"
#include "common/mesh/rdm/layer_sweep.hpp"
#include "common/mesh/rdm/quad_shape.hpp"
#include "common/mesh/rdm/scratch_state.hpp"
#include "common/mesh/rdm/side_axes.hpp"
#include "common/runs/layer.hpp"

namespace runstone {

RdmScratch::RdmScratch() : state_(std::make_unique<State>()) {}
RdmScratch::~RdmScratch() = default;
RdmScratch::RdmScratch(RdmScratch&&) noexcept = default;
RdmScratch& RdmScratch::operator=(RdmScratch&&) noexcept = default;
void RdmScratch::use_plain_path(bool plain) { state_->plain = plain; }

namespace {

using rdm::direction_of;
using rdm::PaletteIndex;
using rdm::RowScratch;
using rdm::Side;
using rdm::side_axes;
using rdm::side_of;
using rdm::SideAxes;
using Scratch = RdmScratch::State;

/// Assigns palette indices to the materials of the chunk and lists those of its runs.
rdm::IndexedRuns index_chunk(const RunChunk& chunk, const VisibilityTable& visibility,
                             Scratch& scratch) {
  rdm::ChunkPalette& palette = scratch.palette;
  palette.clear();
  const std::size_t size = chunk.runs.size();
  const auto list_plainly = [&](auto& indices) {
    indices.resize(size);
    chunk.runs.visit(
        [&](const auto& runs) { palette.list(runs, 0, size, visibility, indices.data()); });
  };
  if (scratch.plain) {
    list_plainly(scratch.byte_indices);
  } else {
    scratch.byte_indices.resize(size);
    rdm::index_runs(chunk.runs, visibility, palette, scratch.byte_indices.data());
  }
  if (!palette.fit_bytes()) {
    list_plainly(scratch.full_indices);
    return {chunk.runs, nullptr, scratch.full_indices.data()};
  }
  // A single transparent material is meshed as a single opaque one.
  if (palette.solid_count() == 1 && palette.has_transparent()) {
    for (rdm::BytePaletteIndex& index : scratch.byte_indices) index = index != 0 ? 1 : 0;
  }
  return {chunk.runs, scratch.byte_indices.data(), nullptr};
}

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
                std::size_t row_count, const rdm::ChunkPalette& palette, std::size_t at,
                rdm::Borders<Row>& borders) {
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
void read_mixed_border(const RunChunk& neighbour, const rdm::LayerPlace& place,
                       const VisibilityTable& visibility, Scratch& scratch, std::size_t at,
                       rdm::Borders<Row>& borders) {
  const rdm::ChunkPalette& palette = scratch.palette;
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
  std::array<typename rdm::Borders<Row>::Rows, 2> planes;
  // With many short runs, reading each voxel of the layer costs less than reading each run of the
  // chunk.
  const bool dense = neighbour.runs.size() > std::size_t{4} * bits * rows;
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
    rdm::read_layer_rows(neighbour, place, planes, class_of);
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
void use_kept_border(const ChunkBorders& kept, Direction touching, const rdm::LayerPlace& place,
                     std::uint32_t bits, std::uint32_t rows, const rdm::ChunkPalette& palette,
                     std::size_t at, rdm::Borders<Row>& borders) {
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
void read_border(const RunChunk& chunk, Direction direction, const RunChunk* neighbour,
                 const ChunkBorders* kept, const SideAxes& axes, const VisibilityTable& visibility,
                 Scratch& scratch, Side side, rdm::Borders<Row>& borders) {
  const std::size_t at = rdm::at(side);
  const rdm::ChunkPalette& palette = scratch.palette;
  auto& hiding = borders.hiding[at];
  borders.meets[at] = false;
  borders.indices[at].clear();
  if (neighbour == nullptr) {
    hiding.fill(0);
    return;
  }
  RUNSTONE_ASSERT(side_of(*neighbour, axes.bit) == side_of(chunk, axes.bit) &&
                  side_of(*neighbour, axes.row) == side_of(chunk, axes.row));
  const std::uint32_t layer = is_positive(direction) ? 0 : side_of(*neighbour, axes.layer) - 1;
  const rdm::LayerPlace place{axes.layer, axes.bit, layer};
  if (kept != nullptr && !neighbour->is_uniform()) {
    RUNSTONE_ASSERT(kept->fits(*neighbour));
    return use_kept_border(*kept, opposite(direction), place, side_of(chunk, axes.bit),
                           side_of(chunk, axes.row), palette, at, borders);
  }
  std::array<typename rdm::Borders<Row>::Rows, 1> plane;
  if (!palette.has_transparent()) {
    rdm::read_layer_rows(*neighbour, place, plane,
                         [table = visibility.data()](Material material) -> PaletteIndex {
                           return table[material] == Visibility::opaque ? 1 : 0;
                         });
    hiding = plane[0];
    return;
  }
  if (palette.solid_count() == 1) {
    rdm::read_layer_rows(
        *neighbour, place, plane,
        [table = visibility.data(), single = palette.single()](Material material) -> PaletteIndex {
          return table[material] == Visibility::opaque || material == single ? 1 : 0;
        });
    hiding = plane[0];
    return;
  }
  read_mixed_border(*neighbour, place, visibility, scratch, at, borders);
}

/// Keeps the chunk's own sides, which the sweep has found.
template <class Row>
void keep_borders(const RunChunk& chunk, const rdm::ChunkPalette& palette,
                  const rdm::SweepState<Row>& sweep, ChunkBorders& out) {
  using Rows = std::array<Row, kRowBits<Row>>;
  static constexpr Rows kNone{};
  const auto axes = side_axes(chunk.order);
  const bool single_transparent = palette.solid_count() == 1 && palette.has_transparent();
  const auto side = [&](std::size_t i) -> ChunkBorders::SideRows<Rows> {
    const rdm::ChunkSide<Row>& found = sweep.chunk_sides[i];
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

template <class Row>
void mesh_chunk(const RunChunk& chunk, const rdm::IndexedRuns& runs,
                const MeshNeighbours& neighbours, const MeshBorders& borders,
                ChunkBorders* chunk_borders, const VisibilityTable& visibility, Scratch& scratch,
                std::unique_ptr<RowScratch<Row>>& rows) {
  if (!rows) rows = std::make_unique<RowScratch<Row>>();
  const auto axes = side_axes(chunk.order);
  const auto strips = rdm::strip_axes(chunk.order);
  rdm::SweepInput input;
  input.runs = runs;
  input.extent = ordered(chunk.extent, chunk.order);
  input.palette = &scratch.palette;
  input.opaque = &scratch.opaque;
  input.transparent = &scratch.transparent;
  input.chunk_sides = chunk_borders != nullptr;
  for (std::size_t side = 0; side < kDirectionCount; ++side) {
    const SideAxes& a = axes[side / 2];
    const Direction direction = direction_of(a.layer, side % 2 != 0);
    input.direction[side] = direction;
    input.shape[side] = rdm::QuadShape(direction, strips[side / 2].strip, strips[side / 2].row);
    const auto d = static_cast<std::size_t>(direction);
    read_border(chunk, direction, neighbours[d], borders[d], a, visibility, scratch,
                static_cast<Side>(side), rows->borders);
  }
  if constexpr (!std::is_same_v<Row, Row32>) {
    if (scratch.plain) rdm::sweep_layers_plain(input, rows->borders, rows->sweep);
  }
  if (!scratch.plain) rdm::sweep_layers(input, rows->borders, rows->sweep);
  if (chunk_borders != nullptr) keep_borders(chunk, scratch.palette, rows->sweep, *chunk_borders);
}

/// Meshes a chunk of one material whose neighbours are missing or of one material each: whole
/// sides, or nothing. Returns false and does nothing if a neighbour has several materials.
bool mesh_uniform(const RunChunk& chunk, const MeshNeighbours& neighbours,
                  const VisibilityTable& visibility, ChunkMesh& out) {
  if (!std::all_of(neighbours.begin(), neighbours.end(),
                   [](const RunChunk* n) { return n == nullptr || n->is_uniform(); })) {
    return false;
  }
  out.clear();
  const Material material = chunk.runs.material(0);
  QuadLayers& pass = visibility[material] == Visibility::transparent ? out.transparent : out.opaque;
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    const Material beyond = neighbours[d] == nullptr ? kEmpty : neighbours[d]->runs.material(0);
    if (!visibility.face_drawn(material, beyond)) continue;
    const auto direction = static_cast<Direction>(d);
    const rdm::StripAxes a = rdm::strip_axes(chunk.order, axis_of(direction));
    const std::uint32_t layer = is_positive(direction) ? side_of(chunk, a.layer) - 1 : 0;
    const rdm::QuadShape shape(direction, a.strip, a.row);
    const Quad strip = shape.open({layer, 0, side_of(chunk, a.strip), 0}, material);
    pass.quads.push_back(shape.close(strip, side_of(chunk, a.row)));
    std::fill(pass.first.begin() + static_cast<std::ptrdiff_t>(d * kSideMax + layer + 1),
              pass.first.end(), static_cast<std::uint32_t>(pass.quads.size()));
  }
  return true;
}

}  // namespace

void mesh_rdm(const RunChunk& chunk, const MeshNeighbours& neighbours,
              const VisibilityTable& visibility, RdmScratch& scratch, ChunkMesh& out) {
  mesh_rdm(chunk, neighbours, MeshBorders{}, visibility, scratch, out);
}

void mesh_rdm(const RunChunk& chunk, const MeshNeighbours& neighbours, const MeshBorders& borders,
              const VisibilityTable& visibility, RdmScratch& scratch, ChunkMesh& out,
              ChunkBorders* chunk_borders) {
  Scratch& state = scratch.state();
  if (chunk.is_uniform()) {
    if (chunk_borders != nullptr) chunk_borders->read(chunk, visibility);
    chunk_borders = nullptr;
    if (visibility[chunk.runs.material(0)] == Visibility::empty) return out.clear();
    if (mesh_uniform(chunk, neighbours, visibility, out)) return;
  }
  const rdm::IndexedRuns runs = index_chunk(chunk, visibility, state);
  if (state.palette.solid_count() == 0) {
    if (chunk_borders != nullptr) chunk_borders->read(chunk, visibility);
    return out.clear();
  }
  const auto sides = chunk.extent.sides();
  const auto longest = *std::max_element(sides.begin(), sides.end());
  const auto mesh_in = [&](auto& rows) {
    mesh_chunk(chunk, runs, neighbours, borders, chunk_borders, visibility, state, rows);
  };
  // The plain path uses rows of 64 bits for all sides up to 64. Its speed does not matter.
  if (longest <= 32 && !state.plain) {
    mesh_in(state.rows_32);
  } else if (longest <= 64) {
    mesh_in(state.rows_64);
  } else {
    mesh_in(state.rows_128);
  }
  state.opaque.finish(sides, out.opaque);
  if (state.palette.has_transparent()) {
    state.transparent.finish(sides, out.transparent);
  } else {
    out.transparent.clear();
  }
}

}  // namespace runstone
