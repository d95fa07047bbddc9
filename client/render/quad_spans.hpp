// QuadSpans: which quads of a chunk are drawn, and in which order. The quads of a mesh are ordered
// by direction and layer, so the faces that point away from the eye are ranges that are left out.
// Pure.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/mesh/chunk_mesh.hpp"

namespace runstone {

/// Quads [first, first + count) of a buffer.
struct QuadSpan {
  std::uint32_t first = 0, count = 0;
  friend bool operator==(const QuadSpan&, const QuadSpan&) = default;
};

/// The quads of one pass of one chunk in a buffer.
class QuadSpans {
 public:
  QuadSpans() = default;
  /// `first` is the place of the first quad in the buffer. Requires layers.first as the mesher sets
  /// it.
  QuadSpans(const QuadLayers& layers, std::int32_t edge, std::uint32_t first);

  QuadSpan all() const;
  /// Appends the spans whose faces may be seen from `eye`, in voxels relative to the chunk's
  /// origin. A place very far away stands for a direction.
  void append_facing(const std::array<double, 3>& eye, std::vector<QuadSpan>& out) const;
  /// Appends a span for each layer with quads, from the farthest plane to the nearest one. Planes
  /// of one axis are in their right order; those of different axes may not be. The faces on the
  /// border of the body are left out for each Direction whose bit is set in `hidden_sides`.
  void append_back_to_front(const std::array<double, 3>& eye, std::vector<QuadSpan>& out,
                            std::uint8_t hidden_sides = 0) const;

 private:
  QuadSpan span(int direction, int from, int to) const;  // layers [from, to)

  int edge_ = 0;
  std::uint32_t first_ = 0;
  std::vector<std::uint32_t> starts_;  // of layer l of direction d: starts_[d * edge_ + l]
};

}  // namespace runstone
