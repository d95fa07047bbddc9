// MonotoneTriangulation: cuts a region into monotone polygons by a sweep, and these into triangles
// (Fournier and Montuno 1984; de Berg et al., Computational Geometry, chapter 3). Exact, in
// integers.
//
// The sweep proceeds row by row and along u in each row, as if every side along u rose a little: no
// two points are then at the same height. Its open elements are slabs, the stretches of the region
// between a left and a right side. A corner where a slab splits in two is joined with the latest
// corner of the slab. A corner where two slabs merge waits for their next corner and is joined with
// that. Nothing lies between the ends of these diagonals. So there are no new points, and no point
// lies within a side of a piece.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tests/reference/sweep_points.hpp"

namespace runstone::reference {

/// An object keeps its buffers between calls. Thread: one.
class MonotoneTriangulation {
 public:
  // Indices of points(), counter-clockwise over u, v.
  using Triangle = std::array<std::uint32_t, 3>;

  /// Triangulates a region of `outlines`. Cost: O(n log n), and O(open slabs) for each corner where
  /// one splits.
  void run(const Outlines& outlines, const Outlines::Region& region);

  /// Returns each corner of the region once, ascending.
  std::span<const LayerPoint> points() const { return sweep_.points; }
  std::span<const Triangle> triangles() const { return triangles_; }

 private:
  using CornerId = std::uint32_t;  // index in sweep_.corners: ascending is upwards
  using PieceId = std::uint32_t;
  using SlabId = std::uint32_t;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// A monotone polygon that is still open at its top. Both chains start with its lowest corner.
  struct Piece {
    std::vector<CornerId> left, right;
  };
  /// A merged slab has two pieces until the next corner joins the merging one. That corner ends the
  /// right chain of one piece and the left chain of the other. Otherwise both are the same piece.
  struct Slab {
    PieceId left_piece = 0, right_piece = 0;
    CornerId left_end = 0, right_end = 0;  // upper ends of its two sides
  };
  struct Stacked {
    CornerId corner;
    bool left;
  };

  LayerPoint at(CornerId corner) const { return sweep_.points[sweep_.corners[corner].point]; }
  PieceId open_piece(CornerId lowest);
  void close_piece(PieceId piece, CornerId top);
  SlabId open_slab(const Slab& slab);
  void close_slab(SlabId slab);
  SlabId slab_around(CornerId corner) const;

  PieceId meet_left(Slab& slab, CornerId corner);
  PieceId meet_right(Slab& slab, CornerId corner);
  void start(CornerId corner);
  void split(CornerId corner);
  void merge(CornerId corner);
  void end(CornerId corner);

  void triangulate(const Piece& piece);
  void add_triangle(CornerId a, CornerId b, CornerId c);

  SweepPoints sweep_;
  std::vector<Triangle> triangles_;
  // The pieces of the last region are those below piece_count_. Some of them are free.
  std::vector<Piece> pieces_;
  std::vector<PieceId> free_pieces_;
  std::uint32_t piece_count_ = 0, slab_count_ = 0;
  std::vector<Slab> slabs_;
  std::vector<SlabId> free_slabs_, open_slabs_;
  // The slab whose left or right side ends at a corner, by corner.
  std::vector<SlabId> left_of_, right_of_;
  std::vector<Stacked> row_, stack_;  // of triangulate()
};

}  // namespace runstone::reference
