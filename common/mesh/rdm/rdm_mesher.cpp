#include "common/mesh/rdm/rdm_mesher.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/border_rows.hpp"
#include "common/mesh/rdm/layer_sweep.hpp"
#include "common/mesh/rdm/material_codes.hpp"
#include "common/mesh/rdm/quad_shape.hpp"
#include "common/mesh/rdm/scratch_state.hpp"

namespace runstone {

RdmScratch::RdmScratch() : state_(std::make_unique<State>()) {}
RdmScratch::~RdmScratch() = default;
RdmScratch::RdmScratch(RdmScratch&&) noexcept = default;
RdmScratch& RdmScratch::operator=(RdmScratch&&) noexcept = default;
void RdmScratch::use_plain_path(bool plain) { state_->plain = plain; }

namespace {

using rdm::Code;
using rdm::Side;
using Scratch = RdmScratch::State;

using rdm::direction_of;
using rdm::RowScratch;
using rdm::side_axes;
using rdm::SideAxes;

/// Numbers the materials of the chunk and lists its runs by code.
void code_runs(const RunChunk& chunk, const VisibilityTable& visibility, Scratch& scratch) {
  scratch.codes.clear();
  scratch.runs.resize(chunk.runs.size());
  chunk.runs.visit([&, out = scratch.runs.data()](const auto& runs) {
    rdm::MaterialCodes& codes = scratch.codes;
    const std::size_t size = runs.size();
    for (std::size_t i = 0; i < size; ++i) out[i] = {runs.end(i), codes.number(runs.material(i), visibility)};
  });
  // A single transparent material is meshed as a single opaque one would be.
  if (scratch.codes.solid_count() == 1 && scratch.codes.has_transparent()) {
    for (rdm::CodedRun& run : scratch.runs) run.code = run.code != 0 ? 1 : 0;
  }
}

template <class Rows, class CodeOf>
void read_planes(const RunChunk& neighbour, rdm::LayerPlace place, unsigned count, Rows* planes,
                 CodeOf code_of) {
  if (neighbour.is_uniform()) {
    const Code code = code_of(neighbour.runs.material(0));
    for (unsigned k = 0; k < count; ++k) {
      planes[k].fill(typename Rows::value_type{0} - (code >> k & 1));
    }
    return;
  }
  rdm::LayerReader<typename Rows::value_type, CodeOf>(neighbour, place, planes, count, code_of);
}

template <class Row>
void read_border(const RunChunk& chunk, Direction direction, const RunChunk* neighbour, const SideAxes& axes,
                 const VisibilityTable& visibility, const rdm::MaterialCodes& codes, Side side,
                 rdm::Borders<Row>& borders) {
  const auto at = static_cast<std::size_t>(side);
  auto& planes = borders.plane[at];
  borders.clear[at] = false;
  if (neighbour == nullptr) {
    planes[0].fill(0);
    return;
  }
  const auto side_of = [](const RunChunk& c, Axis axis) {
    return c.extent.sides()[static_cast<std::size_t>(axis)];
  };
  RUNSTONE_ASSERT(side_of(*neighbour, axes.bit) == side_of(chunk, axes.bit) &&
                  side_of(*neighbour, axes.row) == side_of(chunk, axes.row));
  const bool single = codes.solid_count() == 1;
  const bool mixed = !single && codes.has_transparent();
  const std::uint32_t layer = is_positive(direction) ? 0u : side_of(*neighbour, axes.layer) - 1u;
  const rdm::LayerPlace place{axes.layer, axes.bit, layer};
  if (!mixed) {
    // One material hides itself, whatever its class; it stands here as an opaque one does otherwise.
    const Material own = single ? codes.material(codes.has_transparent(), 0) : kEmpty;
    const Material hiding = own == kEmpty || visibility[own] == Visibility::opaque ? kEmpty : own;
    if (hiding == kEmpty) {
      read_planes(*neighbour, place, 1, planes.data(),
                  [table = visibility.data()](Material material) -> Code {
                    return table[material] == Visibility::opaque ? 1 : 0;
                  });
    } else {
      read_planes(*neighbour, place, 1, planes.data(),
                  [table = visibility.data(), hiding](Material material) -> Code {
                    return table[material] == Visibility::opaque || material == hiding ? 1 : 0;
                  });
    }
    return;
  }
  const unsigned count = codes.clear_bits() + 2;
  read_planes(*neighbour, place, count, planes.data(),
              [&codes, &visibility](Material material) { return codes.border_code(material, visibility); });
  const auto& clear = planes[count - 1];
  borders.clear[at] = std::any_of(clear.begin(), clear.end(), [](Row row) { return row != 0; });
}

template <class Row>
void mesh_chunk(const RunChunk& chunk, const MeshNeighbours& neighbours, const VisibilityTable& visibility,
                Scratch& scratch, std::unique_ptr<RowScratch<Row>>& rows) {
  if (!rows) rows = std::make_unique<RowScratch<Row>>();
  const auto axes = side_axes(chunk.order);
  rdm::SweepInput input;
  input.runs = scratch.runs;
  input.extent = ordered(chunk.extent, chunk.order);
  input.codes = &scratch.codes;
  input.opaque = &scratch.opaque;
  input.transparent = &scratch.transparent;
  for (std::size_t side = 0; side < 6; ++side) {
    const SideAxes& a = axes[side / 2];
    const Direction direction = direction_of(a.layer, side % 2 != 0);
    input.direction[side] = direction;
    // Strips run along the bits of a row, and from row to row where each bit is a layer of its own.
    input.shape[side] = rdm::QuadShape(direction, a.bit, a.row);
    read_border(chunk, direction, neighbours[static_cast<std::size_t>(direction)], a, visibility,
                scratch.codes, static_cast<Side>(side), rows->borders);
  }
  if constexpr (rdm::kRowBits<Row> == 64) {
    if (scratch.plain) return rdm::sweep_layers_plain(input, rows->borders, rows->sweep);
  }
  rdm::sweep_layers(input, rows->borders, rows->sweep);
}

/// Meshes a chunk of one material whose neighbours are missing or of one material each: whole sides, or
/// nothing. Returns false, with nothing done, if a neighbour is of several.
bool mesh_uniform(const RunChunk& chunk, const MeshNeighbours& neighbours, const VisibilityTable& visibility,
                  ChunkMesh& out) {
  if (!std::all_of(neighbours.begin(), neighbours.end(),
                   [](const RunChunk* n) { return n == nullptr || n->is_uniform(); })) {
    return false;
  }
  out.clear();
  const Material material = chunk.runs.material(0);
  const auto axes = side_axes(chunk.order);
  const auto sides = chunk.extent.sides();
  QuadLayers& pass = visibility[material] == Visibility::transparent ? out.transparent : out.opaque;
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    const Material beyond = neighbours[d] == nullptr ? kEmpty : neighbours[d]->runs.material(0);
    if (!visibility.face_drawn(material, beyond)) continue;
    const auto direction = static_cast<Direction>(d);
    const SideAxes& a = *std::find_if(
        axes.begin(), axes.end(), [direction](const SideAxes& s) { return s.layer == axis_of(direction); });
    const std::uint32_t layer = is_positive(direction) ? sides[d / 2] - 1u : 0u;
    const rdm::QuadShape shape(direction, a.bit, a.row);
    const Quad strip = shape.open({layer, 0, sides[static_cast<std::size_t>(a.bit)], 0}, material);
    pass.quads.push_back(shape.close(strip, sides[static_cast<std::size_t>(a.row)]));
    std::fill(pass.first.begin() + static_cast<std::ptrdiff_t>(d * kSideMax + layer + 1), pass.first.end(),
              static_cast<std::uint32_t>(pass.quads.size()));
  }
  return true;
}

}  // namespace

void mesh_rdm(const RunChunk& chunk, const MeshNeighbours& neighbours, const VisibilityTable& visibility,
              RdmScratch& scratch, ChunkMesh& out) {
  Scratch& state = scratch.state();
  const bool solid_somewhere = !chunk.is_uniform() || visibility[chunk.runs.material(0)] != Visibility::empty;
  if (!solid_somewhere) return out.clear();
  if (chunk.is_uniform() && mesh_uniform(chunk, neighbours, visibility, out)) return;
  code_runs(chunk, visibility, state);
  if (state.codes.solid_count() == 0) return out.clear();
  const auto sides = chunk.extent.sides();
  if (*std::max_element(sides.begin(), sides.end()) <= 64) {
    mesh_chunk(chunk, neighbours, visibility, state, state.narrow);
  } else {
    mesh_chunk(chunk, neighbours, visibility, state, state.wide);
  }
  state.opaque.finish(sides, out.opaque);
  if (state.codes.has_transparent()) {
    state.transparent.finish(sides, out.transparent);
  } else {
    out.transparent.clear();
  }
}

}  // namespace runstone
