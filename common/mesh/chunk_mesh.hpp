// ChunkMesh: the quads of one chunk in two draw passes. Those of cubes are kept per direction and
// layer: after an edit only the layers in which a voxel changed (DirtyLayers) and the layers beside
// them are replaced. Those of shapes are made anew.
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

/// The quads of the voxels that are no cubes, whose face is not 0, in two draw passes. They ascend
/// by direction; their order is deterministic. A quad of width or height above 1 stands for equal
/// faces in a row, which join: the first begins at u0 and v0, and the last ends at u1 and v1.
struct ShapeQuads {
  std::vector<Quad> opaque, transparent;
  void clear() {
    opaque.clear();
    transparent.clear();
  }
};

struct ChunkMesh {
  QuadLayers opaque;
  QuadLayers transparent;
  ShapeQuads shapes;
  std::size_t quad_count() const {
    return opaque.quads.size() + transparent.quads.size() + shapes.opaque.size() +
           shapes.transparent.size();
  }
  bool empty() const { return quad_count() == 0; }
  void clear() {
    opaque.clear();
    transparent.clear();
    shapes.clear();
  }
};

}  // namespace runstone
