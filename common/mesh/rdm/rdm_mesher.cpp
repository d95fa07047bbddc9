#include "common/mesh/rdm/rdm_mesher.hpp"

#include <algorithm>

#include "common/mesh/rdm/chunk_sweep.hpp"
#include "common/mesh/rdm/quad_shape.hpp"
#include "common/mesh/rdm/scratch_state.hpp"
#include "common/mesh/rdm/side_axes.hpp"

namespace runstone {

RdmScratch::RdmScratch() : state_(std::make_unique<State>()) {}
RdmScratch::~RdmScratch() = default;
RdmScratch::RdmScratch(RdmScratch&&) noexcept = default;
RdmScratch& RdmScratch::operator=(RdmScratch&&) noexcept = default;
void RdmScratch::use_plain_path(bool plain) { state_->plain = plain; }

namespace {

using rdm::side_of;

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
  RdmScratch::State& state = scratch.state();
  if (chunk.is_uniform()) {
    if (chunk_borders != nullptr) chunk_borders->read(chunk, visibility);
    chunk_borders = nullptr;
    if (visibility[chunk.runs.material(0)] == Visibility::empty) return out.clear();
    if (mesh_uniform(chunk, neighbours, visibility, out)) return;
  }
  const rdm::IndexedRuns runs = rdm::index_runs(chunk, {0, chunk.runs.size()}, visibility, state);
  if (state.palette.solid_count() == 0) {
    if (chunk_borders != nullptr) chunk_borders->read(chunk, visibility);
    return out.clear();
  }
  const rdm::SweepRequest request{chunk, neighbours, borders, visibility, chunk_borders};
  rdm::with_rows(chunk.extent, state, [&]<class Row>(rdm::RowScratch<Row>& rows) {
    const auto part = rdm::SweepPart<Row>::whole(ordered(chunk.extent, chunk.order));
    rdm::sweep_chunk(request, runs, part, state, rows);
  });
  const auto sides = chunk.extent.sides();
  state.opaque.finish(sides, out.opaque);
  if (state.palette.has_transparent()) {
    state.transparent.finish(sides, out.transparent);
  } else {
    out.transparent.clear();
  }
}

}  // namespace runstone
