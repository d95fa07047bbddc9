// MinimumPartition: the faces of a plane in as few rectangles of one material as there can be. T. Ohtsuki
// (ISCAS 1982), Lipski et al. (1979) and L. Ferrari, P. V. Sankar and J. Sklansky (CVGIP 28, 1984) found it; D.
// Eppstein surveys it ("Graph-Theoretic Solutions to Computational Geometry Problems", WG 2009).
//
// Where three of the four faces around a corner are of one material and the fourth is not, the outline turns
// inwards: a concave corner, and from it at least one cut must go. Each cut saves itself if it ends at another
// such corner. So: of all such *chords* take as many as there are that neither cross nor touch, which is an
// independent set of a bipartite graph, since only a chord along u meets one along v; then cut once from every
// concave corner that is left. A component of c concave corners, n chords taken and h holes comes apart into
// c - n - h + 1 rectangles.
//
//   # # #        o o concave corners, joined by a chord: one cut for both
//   # #o- - o# #
//   # # # # # #
//
// Corners at which equal faces touch only across are convex twice over and need no cut, and no chord passes
// them: so shapes that touch themselves or each other there come out right without being told apart, and holes
// need nothing of their own either.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/reference/face_plane.hpp"
#include "tests/reference/independent_set.hpp"

namespace runstone::reference {

/// Buffers reused between calls. Belongs to one thread.
class MinimumPartition {
 public:
  /// Replaces `out` by rectangles that cover each face of `plane` once, by row and place of their first face.
  /// O(faces + m * sqrt(n)) for n chords that meet in m places.
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

  // Corners of faces, row after row, one more a row than faces: whether the edges from it along u and v are
  // walls, whether it is concave, whether it needs a cut of its own no longer.
  std::vector<std::uint8_t> corners_;
  std::array<std::size_t, 2> step_{};         // to the next corner, by Line
  std::array<std::vector<Chord>, 2> chords_;  // by Line
  std::vector<std::uint32_t> chord_at_;       // the chord along v at a corner, plus one; 0: none
  BipartiteGraph meetings_;                   // of chords along u (left) and along v (right)
  IndependentSet taken_;
  std::vector<std::uint8_t> covered_;  // faces that are read off
};

}  // namespace runstone::reference
