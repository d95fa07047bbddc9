#include "tests/reference/dense_grid.hpp"

#include <algorithm>
#include <cstring>
#include <span>

#include "common/core/assert.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/layer.hpp"

namespace runstone::reference {
namespace {

/// Fills [from, to) and up to kSlack materials behind it, in whole vectors without a tail.
inline void fill_beyond(Material* from, const Material* to, Material material) {
  std::array<Material, 16> splat;
  splat.fill(material);
  while (from < to) {
    std::memcpy(from, splat.data(), sizeof splat);
    from += splat.size();
  }
}
static_assert(DenseGrid::kSlack >= 16);

/// Decodes the voxels inside. One fill a run, across the border between two lines: the border is
/// written afterwards.
template <class Runs>
void decode_inside(const Runs& runs, OrderedExtent e, DenseGrid& grid) {
  Material* to = grid.line(0, 0);
  const std::ptrdiff_t gap = grid.line_stride() - static_cast<std::ptrdiff_t>(e.f);
  std::uint32_t line_end = e.f;  // index behind the line of the next voxel
  std::uint32_t lines_left = e.m;
  Material* line_to = to + e.f;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::uint32_t end = runs.end(i);
    while (line_end < end) {
      line_end += e.f;
      line_to += grid.line_stride();
      if (--lines_left == 0) {
        lines_left = e.m;
        line_to += grid.layer_stride() - static_cast<std::ptrdiff_t>(e.m) * grid.line_stride();
      }
    }
    Material* const stop = line_to - (line_end - end);
    fill_beyond(to, stop, runs.material(i));
    to = stop;
    if (line_end == end) {  // the next run starts with a line
      to += gap;
      if (lines_left == 1)
        to += grid.layer_stride() - static_cast<std::ptrdiff_t>(e.m) * grid.line_stride();
    }
  }
}

/// Decodes the border layer in one direction: the neighbour's nearest voxels.
void decode_border(const RunChunk* neighbour, Direction direction, std::vector<Material>& layer,
                   DenseGrid& grid) {
  const std::array<Axis, 3> axes = axes_of(grid.order());
  const auto sides = grid.extent().sides();
  const Axis axis = axis_of(direction);
  const Axis u = axis == axes[0] ? axes[1] : axes[0];
  const Axis v = axis == axes[2] ? axes[1] : axes[2];
  const std::size_t us = sides[static_cast<std::size_t>(u)];
  const std::size_t vs = sides[static_cast<std::size_t>(v)];
  const std::ptrdiff_t at = is_positive(direction) ? sides[static_cast<std::size_t>(axis)] : -1;
  Material* const first = grid.line(0, 0) + at * grid.stride(axis);

  const bool uniform = neighbour == nullptr || neighbour->is_uniform();
  const Material material = neighbour == nullptr ? kEmpty : neighbour->runs.material(0);
  layer.resize(us * vs);
  if (!uniform) {
    const auto theirs = neighbour->extent.sides();
    RUNSTONE_ASSERT(theirs[static_cast<std::size_t>(u)] == us &&
                    theirs[static_cast<std::size_t>(v)] == vs);
    const std::uint32_t depth = theirs[static_cast<std::size_t>(axis)];
    read_layer(*neighbour, axis, is_positive(direction) ? 0 : depth - 1, u, std::span(layer));
  }
  const std::ptrdiff_t us_stride = grid.stride(u);
  for (std::size_t row = 0; row < vs; ++row) {
    Material* to = first + static_cast<std::ptrdiff_t>(row) * grid.stride(v);
    const Material* const from = layer.data() + row * us;
    if (us_stride == 1) {
      uniform ? static_cast<void>(std::fill_n(to, us, material))
              : static_cast<void>(std::copy_n(from, us, to));
      continue;
    }
    for (std::size_t i = 0; i < us; ++i, to += us_stride) *to = uniform ? material : from[i];
  }
}

}  // namespace

void decode(const RunChunk& chunk, const GridNeighbours& neighbours, std::vector<Material>& layer,
            DenseGrid& grid) {
  count_dense_expansion();
  grid.reset(chunk.extent, chunk.order);
  chunk.runs.visit([&](const auto& runs) { decode_inside(runs, grid.sides(), grid); });
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    decode_border(neighbours[d], static_cast<Direction>(d), layer, grid);
  }
}

}  // namespace runstone::reference
