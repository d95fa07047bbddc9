// SweepDelaunay: the constrained Delaunay triangulation of a region by a sweep over its corners, as
// in Poly2Tri (Domiter and Zalik 2008, "Sweep-line algorithm for constrained Delaunay
// triangulation"). Exact, in integers; no new points.
//
// Points come row by row. The point event joins each point to the points of the front that it sees,
// and flips restore the Delaunay property. Then the edge event forces in the sides of the region
// that end in the point. There are two differences from the paper:
// - Its front is a chain from left to right that begins on artificial points below and is smoothed
//   by rules for gaps and basins. Here the front is the hull of the points so far, so that a side
//   always lies within triangles.
// - Its edge event removes the triangles that a side crosses and fills the hole again. Here crossed
//   edges are flipped away (Sloan 1993).
// The result is the same, except for points on one circle.
//
// A point where the region touches itself is one point with four sides, which is no special case
// for a triangulation of points. The original walks outlines and rejects those that touch.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tests/reference/sweep_points.hpp"

namespace runstone::reference {

/// An object keeps its buffers between calls. Thread: one.
class SweepDelaunay {
 public:
  // Indices of points(), counter-clockwise over u, v.
  using Triangle = std::array<std::uint32_t, 3>;

  /// Triangulates a region of `outlines`. Cost: O(n log n) plus flips, which are few in practice
  /// and O(n^2) at worst.
  void run(const Outlines& outlines, const Outlines::Region& region);

  /// Returns each corner of the region once, ascending.
  std::span<const LayerPoint> points() const { return sweep_.points; }
  std::span<const Triangle> triangles() const { return triangles_; }

 private:
  using PointId = std::uint32_t;
  // 3 t + i: the edge from corner i of triangle t to the next corner, with the triangle on its
  // left.
  using EdgeId = std::uint32_t;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// The position of an edge relative to the region. outer: the region is on its right.
  enum class Side : std::uint8_t { free, inner, outer };

  static EdgeId next(EdgeId e) { return e % 3 == 2 ? e - 2 : e + 1; }
  static EdgeId previous(EdgeId e) { return e % 3 == 0 ? e + 2 : e - 1; }
  PointId end_of(EdgeId e) const { return from_[next(e)]; }
  PointId apex_of(EdgeId e) const { return from_[previous(e)]; }
  LayerPoint at(PointId point) const { return sweep_.points[point]; }

  EdgeId add_triangle(PointId a, PointId b, PointId c);
  void join(EdgeId e, EdgeId twin);
  void set_hull(PointId from, PointId to, EdgeId edge);
  std::size_t first_row() const;
  void start_front(std::size_t row);
  void point_event(PointId point);
  void edge_event(PointId from, PointId to);
  void mark(PointId from, PointId to);
  void cross(PointId from, PointId to);
  template <class F>
  void each_edge_from(PointId from, F&& visit) const;
  EdgeId edge_between(PointId from, PointId to) const;
  EdgeId edge_across(PointId from, PointId to) const;
  bool convex(EdgeId e) const;
  void flip(EdgeId e);
  void restore();
  void keep_inner();

  SweepPoints sweep_;
  std::vector<Triangle> triangles_;

  std::vector<PointId> from_;  // by edge, like the next two
  std::vector<EdgeId> twin_;   // kNone on the hull
  std::vector<Side> side_;
  std::vector<EdgeId> edge_of_;  // by point: an edge that starts there
  // The neighbours of each point on the hull, counter-clockwise.
  std::vector<PointId> hull_next_, hull_prev_;
  // The edge from each point on the hull to the next one.
  std::vector<EdgeId> hull_edge_;
  std::vector<EdgeId> doubtful_;  // edges that may have to be flipped
  // Edges given by their ends, since flips change the indices of edges.
  std::vector<std::array<PointId, 2>> crossed_, fresh_;
  std::vector<std::uint8_t> kept_;  // by triangle
};

}  // namespace runstone::reference
