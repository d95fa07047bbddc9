// ChunkMesh: the quads of one chunk, in two draw passes, kept per direction and layer, so that an edit
// replaces the layers it touched and keeps the rest (design: "dirty layers").
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

/// Quads of one pass ordered by direction, then layer; deterministic within a layer.
struct QuadLayers {
  std::vector<Quad> quads;
  /// First quad of each (direction, layer): layer l of direction d starts at first[d * kSideMax + l]; the
  /// last entry is quads.size(). Empty layers repeat their successor's start.
  std::array<std::uint32_t, kDirectionCount * kSideMax + 1> first{};

  std::span<const Quad> layer(Direction d, unsigned l) const {
    const std::size_t i = static_cast<std::size_t>(d) * kSideMax + l;
    return std::span<const Quad>(quads).subspan(first[i], first[i + 1] - first[i]);
  }
  void clear() {
    quads.clear();
    if (first.back() != 0) first.fill(0);  // it ascends
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
