#include <algorithm>
#include <bitset>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/layer_mesher.hpp"
#include "common/mesh/rdm/layer_voxels.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/rdm/scratch_state.hpp"

namespace runstone {
namespace {

using rdm::LayerPatch;
using LayerSet = std::bitset<kSideMax>;

/// The layers of one direction to be meshed again: those with changed voxels, and those that look at them.
LayerSet faces_touched(const LayerSet& changed, bool positive, bool beyond, unsigned side) {
  LayerSet out = changed | (positive ? changed >> 1 : changed << 1);
  if (beyond) out.set(positive ? side - 1 : 0);
  for (unsigned layer = side; layer < kSideMax; ++layer) out.reset(layer);
  return out;
}

/// Meshes the touched layers of one axis again, its negative direction first.
template <class Row>
void mesh_axis(const RunChunk& chunk, Axis axis, const std::array<LayerSet, 2>& touched,
               const MeshNeighbours& neighbours, const VisibilityTable& visibility,
               rdm::RowScratch<Row>& scratch, LayerPatch& patch) {
  const auto axes = rdm::side_axes(chunk.order);
  const rdm::SideAxes& sides =
      *std::find_if(axes.begin(), axes.end(), [axis](const rdm::SideAxes& s) { return s.layer == axis; });
  const auto side_of = [](const RunChunk& c, Axis a) {
    return std::uint32_t{c.extent.sides()[static_cast<std::size_t>(a)]};
  };
  const std::uint32_t depth = side_of(chunk, axis);
  const std::uint32_t bits = side_of(chunk, sides.bit);
  const std::uint32_t rows = side_of(chunk, sides.row);

  // A layer is needed for its own faces and for those that look at it.
  const LayerSet needed = touched[0] | touched[0] >> 1 | touched[1] | touched[1] << 1;
  std::array<std::uint32_t, kSideMax> at;
  std::array<rdm::LayerVoxels<Row>*, kSideMax> decoded;
  std::array<const rdm::LayerVoxels<Row>*, kSideMax> layer{};
  std::size_t count = 0;
  if (scratch.layers.size() < depth) scratch.layers.resize(depth);
  for (std::uint32_t l = 0; l < depth; ++l) {
    if (!needed[l]) continue;
    at[count] = l;
    decoded[count] = &scratch.layers[count];
    layer[l] = decoded[count++];
  }
  if (count == 0) return;
  rdm::decode_layers(chunk, axis, at.data(), decoded.data(), count, visibility);

  for (const bool positive : {false, true}) {
    const Direction direction = rdm::direction_of(axis, positive);
    const LayerSet& faces = touched[positive ? 1 : 0];
    for (std::uint32_t l = 0; l < depth; ++l) {
      if (!faces[l]) continue;
      const bool at_border = l == (positive ? depth - 1 : 0);
      if (at_border) {
        const RunChunk* const neighbour = neighbours[static_cast<std::size_t>(direction)];
        RUNSTONE_ASSERT(neighbour == nullptr ||
                        (side_of(*neighbour, sides.bit) == bits && side_of(*neighbour, sides.row) == rows));
        const std::uint32_t there = positive || neighbour == nullptr ? 0 : side_of(*neighbour, axis) - 1;
        rdm::decode_border(neighbour, axis, there, sides.bit, bits, rows, visibility, scratch.beyond);
      }
      const rdm::LayerVoxels<Row>* const beyond =
          at_border ? &scratch.beyond : layer[positive ? l + 1 : l - 1];
      rdm::mesh_layer({layer[l], beyond, bits, rows, l, rdm::QuadShape(direction, sides.bit, sides.row)},
                      patch.opaque, patch.transparent);
      patch.layers.push_back({static_cast<std::size_t>(direction) * kSideMax + l,
                              static_cast<std::uint32_t>(patch.opaque.size()),
                              static_cast<std::uint32_t>(patch.transparent.size())});
    }
  }
}

/// Puts the layers of a patch in the place of those in `out`. O(quads + layers).
void splice(const LayerPatch& patch, const std::vector<Quad>& quads,
            std::uint32_t LayerPatch::Layer::* end_of, std::vector<Quad>& merged, QuadLayers& out) {
  if (quads.empty() && out.quads.empty()) return;
  merged.clear();
  std::size_t kept = 0;     // old quads before this are in `merged`, or replaced
  std::size_t next = 0;     // first[] before this counts in `merged`
  std::uint32_t begin = 0;  // of the layer's quads in `quads`
  std::uint32_t shift = 0;  // what to add to first[], modulo 2^32
  for (const LayerPatch::Layer& layer : patch.layers) {
    const std::uint32_t old_begin = out.first[layer.index];
    const std::uint32_t old_end = out.first[layer.index + 1];
    merged.insert(merged.end(), out.quads.begin() + static_cast<std::ptrdiff_t>(kept),
                  out.quads.begin() + old_begin);
    merged.insert(merged.end(), quads.begin() + begin, quads.begin() + layer.*end_of);
    kept = old_end;
    if (shift != 0) {
      for (; next <= layer.index; ++next) out.first[next] += shift;
    }
    next = layer.index + 1;
    shift += (layer.*end_of - begin) - (old_end - old_begin);
    begin = layer.*end_of;
  }
  merged.insert(merged.end(), out.quads.begin() + static_cast<std::ptrdiff_t>(kept), out.quads.end());
  for (; next < out.first.size(); ++next) out.first[next] += shift;
  std::swap(merged, out.quads);
}

template <class Row>
void remesh(const RunChunk& chunk, const MeshNeighbours& neighbours, const VisibilityTable& visibility,
            const std::array<LayerSet, kDirectionCount>& touched,
            std::unique_ptr<rdm::RowScratch<Row>>& scratch, LayerPatch& patch) {
  if (!scratch) scratch = std::make_unique<rdm::RowScratch<Row>>();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mesh_axis(chunk, static_cast<Axis>(axis), {touched[axis * 2], touched[axis * 2 + 1]}, neighbours,
              visibility, *scratch, patch);
  }
}

}  // namespace

void mesh_rdm_layers(const RunChunk& chunk, const MeshNeighbours& neighbours,
                     const VisibilityTable& visibility, const DirtyLayers& dirty,
                     const std::bitset<kDirectionCount>& beyond, RdmScratch& scratch, ChunkMesh& mesh) {
  const auto sides = chunk.extent.sides();
  std::array<LayerSet, kDirectionCount> touched;
  std::size_t touched_count = 0;
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    touched[d] = faces_touched(dirty.layer[d / 2], d % 2 != 0, beyond[d], sides[d / 2]);
    touched_count += touched[d].count();
  }
  // A layer on its own costs some times its share of a sweep.
  constexpr std::size_t kSweepLayers = 4;
  if (touched_count * kSweepLayers > std::size_t{2} * (sides[0] + sides[1] + sides[2])) {
    return mesh_rdm(chunk, neighbours, visibility, scratch, mesh);
  }
  RdmScratch::State& state = scratch.state();
  LayerPatch& patch = state.patch;
  patch.layers.clear();
  patch.opaque.clear();
  patch.transparent.clear();
  if (*std::max_element(sides.begin(), sides.end()) <= 64) {
    remesh(chunk, neighbours, visibility, touched, state.narrow, patch);
  } else {
    remesh(chunk, neighbours, visibility, touched, state.wide, patch);
  }
  splice(patch, patch.opaque, &LayerPatch::Layer::opaque_end, patch.merged, mesh.opaque);
  splice(patch, patch.transparent, &LayerPatch::Layer::transparent_end, patch.merged, mesh.transparent);
}

}  // namespace runstone
