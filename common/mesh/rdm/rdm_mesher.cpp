#include "common/mesh/rdm/rdm_mesher.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/divider.hpp"
#include "common/mesh/rdm/face_strips.hpp"
#include "common/mesh/rdm/mesh_run.hpp"
#include "common/mesh/rdm/quad_bins.hpp"
#include "common/mesh/rdm/strip_table.hpp"

namespace runstone {

struct RdmScratch::State {
  std::vector<rdm::MeshRun> runs;         // of the chunk
  std::vector<rdm::MeshRun> border;       // of its border layer
  std::vector<rdm::MeshRun> beyond;       // of the neighbour's layer behind that
  std::vector<Material> layer;            // one layer, where it has to be transposed
  std::array<rdm::StripTable, 2> strips;  // of faces in the negative and the positive direction
  rdm::QuadBins bins;
};

RdmScratch::RdmScratch() : state_(std::make_unique<State>()) {}
RdmScratch::~RdmScratch() = default;
RdmScratch::RdmScratch(RdmScratch&&) noexcept = default;
RdmScratch& RdmScratch::operator=(RdmScratch&&) noexcept = default;

namespace {

using rdm::MeshRun;
using rdm::QuadShape;

using Scratch = RdmScratch::State;

constexpr Direction direction_of(Axis axis, bool positive) {
  return static_cast<Direction>(static_cast<unsigned>(axis) * 2 + (positive ? 1 : 0));
}

/// Faces between each voxel and the one `delay` before it: two cursors over the same runs, the second one
/// that far behind, stop at every index where either run ends. What lies inside one run on both sides costs
/// one step however many lines and layers it spans. O(runs + faces). Requires 0 < delay < volume.
template <class Strips>
void sweep_delayed(std::span<const MeshRun> runs, std::uint32_t delay, Strips& negative, Strips& positive) {
  const std::uint32_t volume = runs.back().end;
  const MeshRun* behind = runs.data();
  const MeshRun* here = std::upper_bound(runs.data(), runs.data() + runs.size(), delay,
                                         [](std::uint32_t i, const MeshRun& run) { return i < run.end; });
  for (std::uint32_t i = delay; i < volume;) {
    const std::uint32_t here_end = here->end;
    const std::uint32_t behind_end = behind->end + delay;
    const std::uint32_t end = std::min(here_end, behind_end);
    if (const unsigned faces = rdm::faces_between(*here, *behind); faces != 0) {
      if ((faces & 1u) != 0) negative.add(i, end, here->material);
      if ((faces & 2u) != 0) positive.add(i - delay, end - delay, behind->material);
    }
    // Added, not branched: which run ends first is as good as random.
    here += here_end == end ? 1 : 0;
    behind += behind_end == end ? 1 : 0;
    i = end;
  }
}

void mesh_slow_axis(OrderedExtent e, const std::array<Axis, 3>& axes, Scratch& scratch, rdm::QuadSink sink) {
  rdm::LayerStrips negative({direction_of(axes[2], false), axes[0], axes[1]}, e.f, e.m, 0, scratch.strips[0],
                            sink);
  rdm::LayerStrips positive({direction_of(axes[2], true), axes[0], axes[1]}, e.f, e.m, 0, scratch.strips[1],
                            sink);
  sweep_delayed(scratch.runs, e.layer(), negative, positive);
  negative.finish();
  positive.finish();
}

void mesh_middle_axis(OrderedExtent e, const std::array<Axis, 3>& axes, Scratch& scratch,
                      rdm::QuadSink sink) {
  rdm::LineStrips negative({direction_of(axes[1], false), axes[0], axes[2]}, e.f, e.m, 0, scratch.strips[0],
                           sink);
  rdm::LineStrips positive({direction_of(axes[1], true), axes[0], axes[2]}, e.f, e.m, e.m - 1,
                           scratch.strips[1], sink);
  sweep_delayed(scratch.runs, e.f, negative, positive);
  negative.finish();
  positive.finish();
}

/// Faces across the fastest axis are the ends of runs, except where a run ends with its line.
void mesh_fast_axis(OrderedExtent e, const std::array<Axis, 3>& axes, Scratch& scratch, rdm::QuadSink sink) {
  rdm::CrossStrips negative({direction_of(axes[0], false), axes[1], axes[2]}, e.f, e.m, scratch.strips[0],
                            sink);
  rdm::CrossStrips positive({direction_of(axes[0], true), axes[1], axes[2]}, e.f, e.m, scratch.strips[1],
                            sink);
  const rdm::Divider line_of(e.f);
  const rdm::Divider slice_of(e.m);
  const std::vector<MeshRun>& runs = scratch.runs;
  for (std::size_t i = 0; i + 1 < runs.size(); ++i) {
    const unsigned faces = rdm::faces_between(runs[i + 1], runs[i]);
    if (faces == 0) continue;
    const std::uint32_t line = line_of(runs[i].end);
    const std::uint32_t f = runs[i].end - line * e.f;
    if (f == 0) continue;
    const std::uint32_t slice = slice_of(line);
    const std::uint32_t middle = line - slice * e.m;
    if ((faces & 1u) != 0) negative.add(f, middle, slice, runs[i + 1].material);
    if ((faces & 2u) != 0) positive.add(f - 1, middle, slice, runs[i].material);
  }
  negative.finish();
  positive.finish();
}

/// Faces of the chunk's outermost layer in one direction against the neighbour's layer behind it. Both are
/// made runs of one layer in the chunk's order and walked together.
void mesh_border(const RunChunk& chunk, Direction direction, const RunChunk* neighbour,
                 const VisibilityTable& visibility, Scratch& scratch, rdm::QuadSink sink) {
  const auto hides = [&](const RunChunk& c) {
    return c.is_uniform() && visibility[c.runs.material(0)] == Visibility::opaque;
  };
  if (neighbour != nullptr && hides(*neighbour)) return;

  const std::array<Axis, 3> axes = axes_of(chunk.order);
  const auto sides = chunk.extent.sides();
  const Axis axis = axis_of(direction);
  const Axis row = axis == axes[0] ? axes[1] : axes[0];  // rows run along the lower of the other two axes
  const Axis column = axis == axes[2] ? axes[1] : axes[2];
  const std::uint32_t row_length = sides[static_cast<std::size_t>(row)];
  const std::uint32_t rows = sides[static_cast<std::size_t>(column)];
  const std::uint32_t layer = is_positive(direction) ? sides[static_cast<std::size_t>(axis)] - 1u : 0u;

  rdm::layer_runs(chunk, axis, layer, row, visibility, scratch.layer, scratch.border);
  if (scratch.border.size() == 1 && scratch.border[0].visibility == Visibility::empty) return;
  if (neighbour == nullptr) {
    scratch.beyond.assign(1, {row_length * rows, kEmpty, Visibility::empty});
  } else {
    const auto theirs = neighbour->extent.sides();
    RUNSTONE_ASSERT(theirs[static_cast<std::size_t>(row)] == row_length &&
                    theirs[static_cast<std::size_t>(column)] == rows);
    const std::uint32_t at = is_positive(direction) ? 0u : theirs[static_cast<std::size_t>(axis)] - 1u;
    rdm::layer_runs(*neighbour, axis, at, row, visibility, scratch.layer, scratch.beyond);
  }

  rdm::LayerStrips strips({direction, row, column}, row_length, rows, layer, scratch.strips[0], sink);
  const MeshRun* inside = scratch.border.data();
  const MeshRun* beyond = scratch.beyond.data();
  for (std::uint32_t i = 0; i < row_length * rows;) {
    const std::uint32_t inside_end = inside->end;
    const std::uint32_t beyond_end = beyond->end;
    const std::uint32_t end = std::min(inside_end, beyond_end);
    if ((rdm::faces_between(*inside, *beyond) & 1u) != 0) strips.add(i, end, inside->material);
    inside += inside_end == end ? 1 : 0;
    beyond += beyond_end == end ? 1 : 0;
    i = end;
  }
  strips.finish();
}

}  // namespace

void mesh_rdm(const RunChunk& chunk, const MeshNeighbours& neighbours, const VisibilityTable& visibility,
              RdmScratch& scratch, ChunkMesh& out) {
  Scratch& state = scratch.state();
  const rdm::QuadSink sink{state.bins, visibility};
  const bool solid_somewhere = !chunk.is_uniform() || visibility[chunk.runs.material(0)] != Visibility::empty;
  if (solid_somewhere) {
    for (unsigned d = 0; d < kDirectionCount; ++d) {
      mesh_border(chunk, static_cast<Direction>(d), neighbours[d], visibility, state, sink);
    }
  }
  if (!chunk.is_uniform()) {
    const OrderedExtent e = ordered(chunk.extent, chunk.order);
    const std::array<Axis, 3> axes = axes_of(chunk.order);
    rdm::chunk_runs(chunk, visibility, state.runs);
    mesh_fast_axis(e, axes, state, sink);
    mesh_middle_axis(e, axes, state, sink);
    mesh_slow_axis(e, axes, state, sink);
  }
  state.bins.finish(out);
}

}  // namespace runstone
