// SweepDelaunay: the constrained Delaunay triangulation of a region by a sweep over its corners, as Poly2Tri
// does it (Domiter and Zalik 2008, "Sweep-line algorithm for constrained Delaunay triangulation"). Exact, in
// integers; no new points.
//
// Points come row by row. Each is joined to what it sees of the front and flips restore the Delaunay property
// (the point event); then the sides of the region that end in it are forced in (the edge event). In two
// things this is not theirs. Their front is a chain from left to right that begins on artificial points below
// and is smoothed by rules for gaps and basins; ours is the hull of the points so far, so that a side always
// lies within triangles. And their edge event empties what a side crosses and fills it anew; ours flips the
// crossed edges away (Sloan 1993). The outcome is the same up to points on one circle.
//
// A point where the region touches itself is one point with four sides, which a triangulation of points does
// not mind: the original walks outlines and refuses those that touch.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tests/reference/sweep_points.hpp"

namespace runstone::reference {

/// Buffers are kept. Belongs to one thread.
class SweepDelaunay {
 public:
  using Triangle = std::array<std::uint32_t, 3>;  // places in points(), counter-clockwise over u, v

  /// Triangulates a region of `outlines`. O(n log n) plus flips, which are few in practice and O(n^2) at
  /// worst.
  void run(const Outlines& outlines, const Outlines::Region& region);

  /// Each corner of the region once, ascending.
  std::span<const LayerPoint> points() const { return sweep_.points; }
  std::span<const Triangle> triangles() const { return triangles_; }

 private:
  using PointId = std::uint32_t;
  using EdgeId =
      std::uint32_t;  // 3 t + i: from corner i of triangle t to the next, the triangle on its left
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// What an edge is to the region.
  enum class Side : std::uint8_t { free, inner, outer };  // outer: the region is on its right

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

  std::vector<PointId> from_;  // by edge, as the next two
  std::vector<EdgeId> twin_;   // kNone on the hull
  std::vector<Side> side_;
  std::vector<EdgeId> edge_of_;                          // by point: one that starts there
  std::vector<PointId> hull_next_, hull_prev_;           // by point on the hull, counter-clockwise
  std::vector<EdgeId> hull_edge_;                        // by point on the hull: to the next one
  std::vector<EdgeId> doubtful_;                         // edges that may have to be flipped
  std::vector<std::array<PointId, 2>> crossed_, fresh_;  // by their ends: flips move edges about
  std::vector<std::uint8_t> kept_;                       // by triangle
};

}  // namespace runstone::reference
