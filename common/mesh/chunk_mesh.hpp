// ChunkMesh: the quads of one chunk in two draw passes, kept per direction and layer. After an edit
// only the layers in which a voxel changed (DirtyLayers) and the layers beside them are replaced.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/quad.hpp"
#include "common/runs/extent.hpp"

namespace runstone {

/// The quads of one pass, ordered by direction, then layer. The order within a layer is
/// deterministic.
struct QuadLayers {
  std::vector<Quad> quads;
  /// The first quad of each (direction, layer): layer l of direction d starts at first[d * kSideMax
  /// + l]. The last entry is quads.size(). An empty layer has the start of the next layer.
  std::array<std::uint32_t, kDirectionCount * kSideMax + 1> first{};

  std::span<const Quad> layer(Direction d, unsigned l) const {
    const std::size_t i = static_cast<std::size_t>(d) * kSideMax + l;
    return std::span<const Quad>(quads).subspan(first[i], first[i + 1] - first[i]);
  }
  void clear() {
    quads.clear();
    if (first.back() != 0) first.fill(0);  // the entries ascend
  }
};

struct ChunkMesh {
  QuadLayers opaque;
  QuadLayers transparent;
  std::size_t quad_count() const { return opaque.quads.size() + transparent.quads.size(); }
  bool empty() const { return quad_count() == 0; }
  void clear() {
    opaque.clear();
    transparent.clear();
  }
};

}  // namespace runstone
