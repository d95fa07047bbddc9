// MeshEdges: whether the triangles of a model close, and where they do not. Internal to this room.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/result.hpp"
#include "common/models/model.hpp"
#include "common/voxelise/model_placement.hpp"

namespace runstone {

/// The edges of a model with open ones that the winding number takes.
inline constexpr std::size_t kOpenEdgesMax = 1'000'000;

enum class MeshClosure : std::uint8_t {
  /// Two triangles share each edge, and run along it in opposite directions.
  closed = 0,
  /// Two triangles share each edge, but some are inverted: they run along it in one direction.
  inverted = 1,
  /// An edge has another number of triangles.
  open = 2,
};

struct MeshEdges {
  MeshClosure closure = MeshClosure::open;
  /// An edge along which the triangles run `times` more often from `from` to `to` than back.
  struct Open {
    UnitPoint from, to;
    std::int32_t times = 0;
  };
  /// Empty if the closure is `closed`. Empty as well if each edge has as many triangles in either
  /// direction, as a mesh has that touches itself along an edge, or that occurs twice.
  std::vector<Open> open;
};

/// Counts the triangles of each edge. Vertices with equal snapped positions are one vertex, as in a
/// file in which each triangle has vertices of its own. Triangles with two equal vertices do not
/// count. Fails with limit_exceeded if more than kOpenEdgesMax edges are open. Cost: O(triangles +
/// vertices). Memory: 12 bytes a vertex and 64 MiB (or 4 bytes for each edge of one vertex), and 6
/// to 12 bytes a vertex while it joins them.
Result<MeshEdges> mesh_edges(const Model& model, const ModelPlacement& placement);

}  // namespace runstone
