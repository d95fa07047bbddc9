// MinimumPartition: the faces of a plane in the fewest possible rectangles of one material.
// Sources: T. Ohtsuki (ISCAS 1982), Lipski et al. (1979) and L. Ferrari, P. V. Sankar and J.
// Sklansky (CVGIP 28, 1984); survey: D. Eppstein, "Graph-Theoretic Solutions to Computational
// Geometry Problems" (WG 2009).
//
// Where three of the four faces around a corner have one material and the fourth has not, the
// outline turns inwards: a concave corner. At least one cut must start there. A cut that ends at
// another concave corner serves both. So the algorithm has two steps:
// - Take the largest set of such *chords* that neither cross nor touch. It is an independent set of
//   a bipartite graph, since a chord along u meets only chords along v.
// - Cut once from every remaining concave corner.
// A component of c concave corners, n chords taken and h holes then has c - n - h + 1 rectangles.
//
//   # # #        o o concave corners, joined by a chord: one cut for both
//   # #o- - o# #
//   # # # # # #
//
// A corner at which equal faces touch only diagonally is convex for both and needs no cut, and no
// chord passes it. So shapes that touch themselves or each other there need no special case, and
// neither do holes.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/reference/face_plane.hpp"
#include "tests/reference/independent_set.hpp"

namespace runstone::reference {

/// Finds such partitions. An object keeps its buffers between calls. Thread: one.
class MinimumPartition {
 public:
  /// Replaces `out` by rectangles that cover each face of `plane` once, by row and place of their
  /// first face. Cost: O(faces + m * sqrt(n)) for n chords that meet in m places.
  void find(const FacePlane& plane, std::vector<PlaneRectangle>& out);

 private:
  enum Line : std::size_t { along_u, along_v };
  struct Chord {
    std::size_t from, to;  // corners
  };

  void find_corners(const FacePlane& plane);
  void find_chords(Line line);
  void cut_chords();
  void cut_from_corners_left();
  void read_off(const FacePlane& plane, std::vector<PlaneRectangle>& out);

  bool is_wall(std::size_t corner, Line line) const;
  bool is_crossed(std::size_t corner, Line line) const;
  void cut(std::size_t from, std::size_t to, Line line);

  // The corners of faces, row after row, one more a row than faces. Flags: the edges from it along
  // u and v are walls; it is concave; it needs no further cut of its own.
  std::vector<std::uint8_t> corners_;
  std::array<std::size_t, 2> step_{};         // to the next corner, by Line
  std::array<std::vector<Chord>, 2> chords_;  // by Line
  // The chord along v at a corner, plus one; 0: none.
  std::vector<std::uint32_t> chord_at_;
  // Meetings of chords along u (left) and along v (right).
  BipartiteGraph meetings_;
  IndependentSet taken_;
  std::vector<std::uint8_t> covered_;  // faces whose rectangle is in the output
};

}  // namespace runstone::reference
