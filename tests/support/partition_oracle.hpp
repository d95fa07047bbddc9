// How few rectangles a region of equal faces falls apart into, found without the algorithm that is tested: by
// trying all partitions of small regions, and by counting corners, chords and holes of any.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "tests/reference/face_plane.hpp"
#include "tests/reference/independent_set.hpp"

namespace runstone::test {

/// Regions of a grid of `width` x `height` as bits, row after row.
class LeastRectangles {
 public:
  /// Requires width * height <= 64; beyond 36 it takes too long.
  LeastRectangles(unsigned width, unsigned height) : width_(width), height_(height) {}
  /// The fewest rectangles that cover each cell of a region once. All ways to place the rectangle that holds
  /// the first cell, and the rest of each; what was found is kept.
  unsigned of(std::uint64_t region);

 private:
  unsigned width_, height_;
  std::unordered_map<std::uint64_t, unsigned> known_;
};

/// The same of all materials of a plane by the formula: concave corners, less the most chords that neither
/// cross nor touch, less holes, plus one, for each component. Everything is counted cell by cell. O(chords^2).
std::size_t least_rectangles_by_formula(const reference::FacePlane& plane);

/// Edges of the largest matching of a bipartite graph, by one augmenting path after the other.
std::size_t matching_size(const reference::BipartiteGraph& graph);

/// What is wrong with rectangles as a partition of a plane: a cell left out or covered twice, a material that is
/// not the cells'. Nothing if all is well.
std::string partition_fault(const reference::FacePlane& plane,
                            const std::vector<reference::PlaneRectangle>& rectangles);

}  // namespace runstone::test
