// Outlines: the faces of a layer as polygons (thesis 4.2.11). Faces of one material that are
// connected by their sides are a region. Each region is an outer ring and a ring for each of its
// holes.
//
// A region may touch itself at a corner only, with two faces on one diagonal and none on the other.
// It is not connected there: the ring stays with the face along which it came, passes the corner
// once for each of the two faces, and is weakly simple. A hole that touches the outline, or another
// hole, is therefore part of that ring. If the rings were traced across the corner, they would
// share a point, which the original Poly2Tri rejects.
#pragma once
#include <cstdint>
#include <vector>

#include "tests/reference/face_plane.hpp"
#include "tests/reference/layer_point.hpp"

namespace runstone::reference {

struct Outlines {
  struct Ring {
    std::uint32_t first = 0, count = 0;  // points
  };
  struct Region {
    Material material = kEmpty;
    std::uint32_t first_ring = 0, ring_count = 0;  // the outer one first
    std::uint32_t touching = 0;                    // corners at which it touches itself
  };
  /// Corners only: sides alternate between u and v. The region lies on the left, so outer rings run
  /// counter-clockwise over u, v and holes clockwise. No corner lies within a side of the same
  /// region.
  std::vector<LayerPoint> points;
  std::vector<Ring> rings;
  std::vector<Region> regions;

  void clear() {
    points.clear();
    rings.clear();
    regions.clear();
  }
};

/// Traces the regions of planes. An object keeps its buffers between calls. Thread: one.
class OutlineTracer {
 public:
  /// Replaces `out` by the outlines of a plane, regions by their lowest row, then along u. Cost:
  /// O(faces).
  void trace(const FacePlane& plane, Outlines& out);

 private:
  struct Cell {
    std::int16_t u, v;
  };
  std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(u + 1) + stride_ * static_cast<std::size_t>(v + 1);
  }
  void gather(const FacePlane& plane, int u, int v);
  void trace_ring(int u, int v, Outlines& out);

  std::size_t stride_ = 0;
  // The region of each face, from 1. A margin of 0 lies around the plane.
  std::vector<std::uint32_t> region_;
  // 1 if the side of a face towards -v belongs to a ring, otherwise 0.
  std::vector<std::uint8_t> traced_;
  std::vector<Cell> cells_;  // of the present region
  std::uint32_t regions_ = 0;
};

}  // namespace runstone::reference
