#include "common/mesh/rdm/rdm_mesher.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <vector>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/border_rows.hpp"
#include "common/mesh/rdm/chunk_palette.hpp"
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

/// Assigns palette indices to the materials of the chunk and lists its runs by index.
void index_runs(const RunChunk& chunk, const VisibilityTable& visibility, Scratch& scratch) {
  scratch.palette.clear();
  scratch.runs.resize(chunk.runs.size());
  chunk.runs.visit([&, out = scratch.runs.data()](const auto& runs) {
    rdm::ChunkPalette& palette = scratch.palette;
    const std::size_t size = runs.size();
    for (std::size_t i = 0; i < size; ++i)
      out[i] = {runs.end(i), palette.index_of(runs.material(i), visibility)};
  });
  // A single transparent material is meshed as a single opaque one.
  if (scratch.palette.solid_count() == 1 && scratch.palette.has_transparent()) {
    for (rdm::PaletteRun& run : scratch.runs) run.index = run.index != 0 ? 1 : 0;
  }
}

/// Copies the rows of bits that a neighbour's holder keeps, in the chunk's orientation.
template <class Rows>
void copy_border(const ChunkBorders& borders, const RunChunk& of, Direction side, Axis bit_axis,
                 Rows& out) {
  using Row = typename Rows::value_type;
  RUNSTONE_ASSERT(borders.fits(of));
  const std::uint32_t* from = borders.rows(side);
  const std::size_t words = borders.row_words(side);
  const std::size_t count = borders.row_count(side);
  if (words == 1) {
    std::copy_n(from, count, out.begin());
  } else if (words == 2) {
    for (std::size_t r = 0; r < count; ++r) out[r] = from[2 * r] | Row{from[2 * r + 1]} << 32;
  } else {
    for (std::size_t r = 0; r < count; ++r) {
      Row row = 0;
      for (std::size_t w = words; w != 0; --w) row = row << 32 | from[w - 1];
      from += words;
      out[r] = row;
    }
  }
  if (borders.bit_axis(side) == bit_axis) return;
  std::fill(out.begin() + static_cast<std::ptrdiff_t>(count), out.end(), Row{0});
  transpose(out);
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
  borders.meets[at] =
      std::any_of(planes[1].begin(), planes[1].end(), [](Row row) { return row != 0; });
  if (!borders.meets[at] || palette.transparent_count() == 1) return;
  if (!dense) read_voxels();
  std::transform(voxels.begin(), voxels.end(), std::back_inserter(borders.indices[at]),
                 [&palette](Material material) { return palette.transparent_index(material); });
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
  std::array<typename rdm::Borders<Row>::Rows, 1> plane;
  const Direction touching = opposite(direction);
  const bool is_kept = kept != nullptr && !neighbour->is_uniform();
  if (!palette.has_transparent() || (is_kept && !kept->has_transparent(touching))) {
    if (is_kept) return copy_border(*kept, *neighbour, touching, axes.bit, hiding);
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

template <class Row>
void mesh_chunk(const RunChunk& chunk, const MeshNeighbours& neighbours, const MeshBorders& borders,
                ChunkBorders* chunk_borders, const VisibilityTable& visibility, Scratch& scratch,
                std::unique_ptr<RowScratch<Row>>& rows) {
  if (!rows) rows = std::make_unique<RowScratch<Row>>();
  const auto axes = side_axes(chunk.order);
  const auto strips = rdm::strip_axes(chunk.order);
  rdm::SweepInput input;
  input.runs = scratch.runs;
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
  if (scratch.plain) {
    rdm::sweep_layers_plain(input, rows->borders, rows->sweep);
  } else {
    rdm::sweep_layers(input, rows->borders, rows->sweep);
  }
  if (chunk_borders != nullptr)
    chunk_borders->keep(chunk, rows->sweep.chunk_sides, rows->sweep.sides_transparent);
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
  index_runs(chunk, visibility, state);
  const bool single_transparent =
      state.palette.solid_count() == 1 && state.palette.has_transparent();
  if (chunk_borders != nullptr && (state.palette.solid_count() == 0 || single_transparent)) {
    // The sweep does not run, or does not distinguish this material from an opaque one.
    chunk_borders->read(chunk, visibility);
    chunk_borders = nullptr;
  }
  if (state.palette.solid_count() == 0) return out.clear();
  const auto sides = chunk.extent.sides();
  if (*std::max_element(sides.begin(), sides.end()) <= 64) {
    mesh_chunk(chunk, neighbours, borders, chunk_borders, visibility, state, state.narrow);
  } else {
    mesh_chunk(chunk, neighbours, borders, chunk_borders, visibility, state, state.wide);
  }
  state.opaque.finish(sides, out.opaque);
  if (state.palette.has_transparent()) {
    state.transparent.finish(sides, out.transparent);
  } else {
    out.transparent.clear();
  }
}

}  // namespace runstone
